// Who may ask.
#include <algorithm>
#include <array>

#include "pos/io/text.hpp"
#include "pos/serve/request.hpp"

namespace pos::serve {
namespace {

/// "127.0.0.1" of "127.0.0.1:8080", "[::1]" of "[::1]:8080".
std::string_view withoutPort(std::string_view host) {
  const std::size_t bracket = host.find(']');
  const std::size_t from = bracket == std::string_view::npos ? 0 : bracket;
  return host.substr(0, std::min(host.find(':', from), host.size()));
}

bool isLoopback(std::string_view host) {
  constexpr std::array<std::string_view, 3> kNames{"127.0.0.1", "localhost", "[::1]"};
  return std::find(kNames.begin(), kNames.end(), withoutPort(host)) != kNames.end();
}

/// Takes as long for a nearly right token as for a wrong one.
bool isSame(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference |= static_cast<unsigned>(static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]));
  return difference == 0;
}

/// The value of our cookie in "a=1; pos_token=2".
std::string_view tokenIn(std::string_view cookies) {
  while (!cookies.empty()) {
    const std::size_t end = std::min(cookies.find(';'), cookies.size());
    const std::string_view cookie = io::text::trimmed(cookies.substr(0, end));
    if (cookie.starts_with(kTokenCookie) && cookie.substr(kTokenCookie.size()).starts_with('='))
      return cookie.substr(kTokenCookie.size() + 1);
    cookies.remove_prefix(std::min(end + 1, cookies.size()));
  }
  return {};
}

bool knowsToken(const Guard& guard, const Asker& asker) {
  constexpr std::string_view kBearer = "Bearer ";
  const std::string_view authorization = asker.authorization;
  const bool bearer =
      authorization.starts_with(kBearer) && isSame(authorization.substr(kBearer.size()), guard.token);
  return bearer || isSame(asker.token, guard.token) || isSame(tokenIn(asker.cookie), guard.token);
}

bool sameOrigin(std::string_view origin, std::string_view host) {
  const std::size_t scheme = origin.find("://");
  return scheme != std::string_view::npos && origin.substr(scheme + 3) == host;
}

}  // namespace

void requireAllowed(const Guard& guard, const Asker& asker) {
  if (!asker.origin.empty() && !sameOrigin(asker.origin, asker.host)) {
    throw RequestError(
        403, "forbidden_origin",
        Complaint{.what = "a page from elsewhere may not ask this server", .got = asker.origin});
  }
  if (guard.loopback && !isLoopback(asker.host)) {
    throw RequestError(403, "forbidden_host",
                       Complaint{.what = "this server answers to this machine's own names only",
                                 .got = asker.host,
                                 .expected = "127.0.0.1, localhost or [::1]"});
  }
  if (!guard.loopback && !knowsToken(guard, asker)) {
    throw RequestError(401, "unauthorised",
                       Complaint{.what = "the token is missing or wrong",
                                 .suggestion = "open the address that pos serve printed at its start"});
  }
}

}  // namespace pos::serve
