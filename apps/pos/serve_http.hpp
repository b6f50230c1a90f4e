#pragma once
/// The session over HTTP. Protocol: docs/formats/serve.md. The only file that knows the HTTP library is the
/// .cpp.

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "pos/serve/map_service.hpp"
#include "pos/serve/request.hpp"
#include "serve_hub.hpp"
#include "serve_session.hpp"

namespace pos::app {

/// A file of the browser interface, or another whole answer.
struct Asset {
  std::string type = {};
  std::string bytes = {};
};
/// By path ("/index.html"); read once, so that no request ever names a file.
using Assets = std::map<std::string, Asset>;
/// Of a folder; a page that says what is missing where there is none.
Assets assetsOf(const std::optional<std::filesystem::path>& folder);

/// All that requests are answered from.
struct Site {
  Session& session;
  Hub& hub;
  Ticker& ticker;
  serve::MapService* map = nullptr;  ///< null where there is no map file
  serve::Guard guard = {};
  Assets assets = {};
  serve::ConnectionRules connections = {};
};

/// `/api/info`.
std::string infoJson(const Site& site);

class HttpServer {
 public:
  static constexpr std::size_t kMostBody = 8U << 20;
  static constexpr int kMostStreams = 60;

  explicit HttpServer(Site& site);
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;
  HttpServer(HttpServer&&) = delete;
  HttpServer& operator=(HttpServer&&) = delete;
  ~HttpServer();

  /// Takes the port (0: a free one) and returns it. Throws UsageError when it cannot be had.
  int bind(const std::string& address, int port);
  /// Answers until stop().
  void run();
  void stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pos::app
