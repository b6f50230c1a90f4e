#pragma once
/// Set-up errors. Apps catch them once, in main, and end with `exitCode()`.
/// What happens while running (a gated range, a late scan) is a Verdict, not an error.

#include <stdexcept>
#include <string>

namespace pos {

/// A place in a text file; line and column count from 1, 0 = unknown.
struct FilePlace {
  std::string file = {};
  int line = 0;
  int column = 0;
};

/// "file:line:column", shorter where parts are unknown.
std::string toString(const FilePlace& place);

/// What a complaint tells its reader, written with designated initialisers. Empty fields are left out of the
/// message.
struct Complaint {
  std::string what = {};        ///< one sentence: what is wrong
  FilePlace place = {};         ///< where
  std::string key = {};         ///< key path: "estimators[1].range_std_m"
  std::string got = {};         ///< the value found
  std::string expected = {};    ///< type, unit, range or choices
  std::string suggestion = {};  ///< what to do
};

/// The complaint as a short paragraph of text, one field a line.
std::string toString(const Complaint& complaint);

class Error : public std::runtime_error {
 public:
  explicit Error(const Complaint& complaint)
      : std::runtime_error(toString(complaint)), complaint_(complaint) {}
  explicit Error(const std::string& what) : Error(Complaint{.what = what}) {}
  const Complaint& complaint() const { return complaint_; }
  virtual int exitCode() const { return 1; }

 private:
  Complaint complaint_;
};

/// The command line asks for something that cannot be.
class UsageError : public Error {
 public:
  using Error::Error;
  int exitCode() const override { return 2; }
};

/// A configuration or map file is wrong.
class ConfigError : public Error {
 public:
  using Error::Error;
  int exitCode() const override { return 3; }
};

/// A `--require` was missed.
class RequirementMissed : public Error {
 public:
  using Error::Error;
  int exitCode() const override { return 4; }
};

/// A log, trajectory or table is missing, damaged or too short.
class DataError : public Error {
 public:
  using Error::Error;
  int exitCode() const override { return 5; }
};

/// A bug of ours: thrown when a condition that the code itself guarantees does not hold.
class ContractError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// Throws ContractError with `message` unless `holds`.
inline void ensure(bool holds, const char* message) {
  if (!holds) throw ContractError(message);
}

}  // namespace pos
