#pragma once
/// Requests and their answers, without HTTP.

#include <string>
#include <utility>
#include <vector>

#include "serve_http.hpp"

namespace pos::app {

struct Answer {
  std::string type = "application/json";
  std::string body = {};
  std::vector<std::pair<std::string, std::string>> headers = {{"Cache-Control", "no-store"}};
};

/// All throw RequestError.
Answer answerToGet(Site& site, const serve::Target& target);
Answer answerToPost(Site& site, const serve::Target& target, const std::string& body);
Answer answerToPut(Site& site, const serve::Target& target, const std::string& body,
                   const std::string& if_match);

}  // namespace pos::app
