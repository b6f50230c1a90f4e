#include "serve_http.hpp"

#include <httplib.h>

#include <atomic>

#include "pos/core/error.hpp"
#include "serve_answers.hpp"

namespace pos::app {
namespace {

using serve::RequestError;

constexpr std::size_t kOtherThreads = 24;  // beside one for each open stream

serve::Asker askerOf(const httplib::Request& request, const serve::Target& target) {
  const auto token = target.query.find("token");
  return {.host = request.get_header_value("Host"),
          .origin = request.get_header_value("Origin"),
          .authorization = request.get_header_value("Authorization"),
          .cookie = request.get_header_value("Cookie"),
          .token = token != target.query.end() ? token->second : ""};
}

void requireJson(const httplib::Request& request) {
  const std::string type = request.get_header_value("Content-Type");
  if (type.starts_with("application/json") || type.starts_with("application/geo+json")) return;
  throw RequestError(415, "bad_type",
                     Complaint{.what = "the body is not sent as JSON",
                               .key = "Content-Type",
                               .got = type,
                               .expected = "application/json or application/geo+json"});
}

void fail(httplib::Response& response, int status, const std::string& text) {
  response.status = status;
  response.set_content(text, "application/json");
}

/// What httplib itself refuses.
void explain(const httplib::Request&, httplib::Response& response) {
  if (!response.body.empty()) return;
  const bool large = response.status == 413;
  const std::string code = large ? "too_large" : response.status == 404 ? "not_found" : "bad_request";
  const std::string what = large ? "the body is larger than 8 MiB" : "the request cannot be read";
  response.set_content(serve::errorJson(response.status, code, Complaint{.what = what}), "application/json");
}

/// Answers of `work`, errors included.
template <class Work>
void answered(httplib::Response& response, Work&& work) {
  try {
    work();
  } catch (const RequestError& error) {
    fail(response, error.status(), serve::errorJson(error));
  } catch (const Error& error) {
    fail(response, 500, serve::errorJson(500, "internal", error.complaint()));
  } catch (const std::exception& error) {
    fail(response, 500, serve::errorJson(500, "internal", Complaint{.what = error.what()}));
  }
}

}  // namespace

struct HttpServer::Impl {
  explicit Impl(Site& the_site) : site(the_site) {}

  void guard(const httplib::Request& request, const serve::Target& target, httplib::Response& response) const;
  void get(const serve::Target& target, httplib::Response& response);
  void withBody(const httplib::Request& request, httplib::Response& response);
  void stream(httplib::Response& response);
  static void send(const Answer& answer, httplib::Response& response);

  Site& site;
  httplib::Server server;
  std::atomic<int> streams{0};
};

void HttpServer::Impl::guard(const httplib::Request& request, const serve::Target& target,
                             httplib::Response& response) const {
  const serve::Asker asker = askerOf(request, target);
  serve::requireAllowed(site.guard, asker);
  if (!site.guard.loopback && !asker.token.empty()) {
    response.set_header("Set-Cookie", std::string(serve::kTokenCookie) + "=" + asker.token +
                                          "; Path=/; HttpOnly; SameSite=Strict");
  }
}

void HttpServer::Impl::send(const Answer& answer, httplib::Response& response) {
  for (const auto& [name, value] : answer.headers) response.set_header(name, value);
  response.status = 200;
  response.set_content(answer.body, answer.type);
}

void HttpServer::Impl::stream(httplib::Response& response) {
  if (++streams > kMostStreams) {
    --streams;
    throw RequestError(503, "too_many_streams",
                       Complaint{.what = std::to_string(kMostStreams) + " streams are open already"});
  }
  const auto next = std::make_shared<std::optional<std::uint64_t>>();
  response.set_header("Cache-Control", "no-store");
  response.set_chunked_content_provider(
      "text/event-stream",
      [this, next](std::size_t, httplib::DataSink& sink) {
        const Hub::Batch batch = *next ? site.hub.after(**next) : site.hub.beginning();
        *next = batch.next;
        if (site.hub.closed()) {
          sink.done();
          return true;
        }
        return batch.text.empty() || sink.write(batch.text.data(), batch.text.size());
      },
      [this](bool) { --streams; });
}

void HttpServer::Impl::get(const serve::Target& target, httplib::Response& response) {
  if (target.pathText() == "/api/stream") {
    serve::requireOnly(target, {});
    stream(response);
    return;
  }
  send(answerToGet(site, target), response);
}

void HttpServer::Impl::withBody(const httplib::Request& request, httplib::Response& response) {
  answered(response, [&] {
    requireJson(request);
    const serve::Target target = serve::parsedTarget(request.target);
    if (request.method == "PUT") {
      send(answerToPut(site, target, request.body, request.get_header_value("If-Match")), response);
    } else {
      send(answerToPost(site, target, request.body), response);
    }
  });
}

HttpServer::HttpServer(Site& site) : impl_(std::make_unique<Impl>(site)) {
  httplib::Server& server = impl_->server;
  server.new_task_queue = [] { return new httplib::ThreadPool(kMostStreams + kOtherThreads); };
  server.set_payload_max_length(kMostBody);
  server.set_keep_alive_timeout(2);
  server.set_read_timeout(10, 0);
  server.set_write_timeout(10, 0);
  server.set_tcp_nodelay(true);
  server.set_error_handler(explain);
  server.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
    using Next = httplib::Server::HandlerResponse;
    // The library would compress every answer with brotli at its slowest level.
    const_cast<httplib::Request&>(request).headers.erase("Accept-Encoding");
    Next next = Next::Handled;
    answered(response, [&] {
      response.set_header("X-Content-Type-Options", "nosniff");
      const serve::Target target = serve::parsedTarget(request.target);
      impl_->guard(request, target, response);
      const bool reads = request.method == "GET" || request.method == "HEAD";
      const bool writes = request.method == "POST" || request.method == "PUT";
      if (!reads && !writes) {
        throw RequestError(
            405, "wrong_method",
            Complaint{.what = "this server has no use for that method", .got = request.method});
      }
      if (reads) impl_->get(target, response);
      if (writes) next = Next::Unhandled;
    });
    return next;
  });
  const auto with_body = [this](const httplib::Request& request, httplib::Response& response) {
    impl_->withBody(request, response);
  };
  server.Post("/.*", with_body);
  server.Put("/.*", with_body);
}

HttpServer::~HttpServer() = default;

int HttpServer::bind(const std::string& address, int port) {
  const bool any = port == 0;
  const int bound = any                                         ? impl_->server.bind_to_any_port(address)
                    : impl_->server.bind_to_port(address, port) ? port
                                                                : -1;
  if (bound > 0) return bound;
  throw UsageError(Complaint{.what = "this address and port cannot be served",
                             .key = "--port",
                             .got = address + ":" + std::to_string(port),
                             .suggestion = "another program may have it: try another port, or 0 for any"});
}

void HttpServer::run() {
  impl_->server.listen_after_bind();
}

void HttpServer::stop() {
  impl_->server.stop();
}

}  // namespace pos::app
