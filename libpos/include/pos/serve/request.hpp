#pragma once
/// What a browser asks for, checked before anything is done with it. Answers: docs/formats/serve.md.

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pos/core/error.hpp"
#include "pos/core/stamp.hpp"

namespace pos::serve {

/// A request that is answered with an error instead of what it asked for.
class RequestError : public Error {
 public:
  RequestError(int status, std::string code, const Complaint& complaint)
      : Error(complaint), status_(status), code_(std::move(code)) {}
  int status() const { return status_; }
  const std::string& code() const { return code_; }

 private:
  int status_;
  std::string code_;
};
/// Status 400, code bad_request.
RequestError badRequest(const Complaint& complaint);
/// Status 404, code not_found.
RequestError notFound(const std::string& what);

/// The error as JSON text.
std::string errorJson(const RequestError& error);
/// The same from any other error that a request ran into: status 422 with this code.
std::string errorJson(int status, const std::string& code, const Complaint& complaint);

/// Path and query of a request line, decoded.
struct Target {
  std::vector<std::string> path = {};  ///< segments; none for "/"
  std::map<std::string, std::string> query = {};

  /// "/api/map", for messages and tables.
  std::string pathText() const;
};
/// Throws RequestError for what is no target: bytes that are not escaped as they should be, control
/// characters, "." and ".." and empty segments, a slash or backslash inside one, a parameter given twice,
/// more than 4096 bytes.
Target parsedTarget(std::string_view text);

/// Throws RequestError for a parameter that is none of these.
void requireOnly(const Target& target, const std::vector<std::string>& known);
/// The parameter as a number, or nothing where it is not given. Throws RequestError for what is no number
/// from `min` to `max`.
std::optional<double> numberOf(const Target& target, const std::string& name, double min, double max);
std::optional<Stamp> stampOf(const Target& target, const std::string& name);
std::optional<std::size_t> countOf(const Target& target, const std::string& name, std::size_t min,
                                   std::size_t max);

/// Who may ask.
struct Guard {
  bool loopback = true;    ///< served to this machine alone
  std::string token = {};  ///< otherwise everybody has to know this
};
/// What a request says of itself; empty where it says nothing.
struct Asker {
  std::string host = {};
  std::string origin = {};
  std::string authorization = {};
  std::string cookie = {};
  std::string token = {};  ///< of the query
};
/// Throws RequestError 401 or 403.
void requireAllowed(const Guard& guard, const Asker& asker);
/// The name of the cookie that keeps the token.
inline constexpr std::string_view kTokenCookie = "pos_token";

}  // namespace pos::serve
