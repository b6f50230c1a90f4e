#pragma once
/// The session over HTTP. Protocol: docs/formats/serve.md. The only file that knows the HTTP library is the
/// .cpp.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "interface_files.hpp"
#include "pos/serve/map_service.hpp"
#include "pos/serve/request.hpp"
#include "serve_hub.hpp"
#include "serve_session.hpp"

namespace pos::app {

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

/// `/api/info`. `map` is null where there is no map file.
std::string infoJson(Session& session, const serve::MapService* map,
                     const serve::ConnectionRules& connections);
/// The picture under the map, or nothing where it has none.
std::optional<Asset> backgroundOf(const std::filesystem::path& map_file);

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
