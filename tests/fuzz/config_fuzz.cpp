/// libFuzzer entry: any bytes given as a replay configuration, as a map and as an override load or throw
/// ConfigError. Build with clang: -fsanitize=fuzzer,address,undefined and the sources of core, map,
/// estimation and io's configuration part. Not part of the normal build.

#include <cstdint>
#include <string>

#include "pos/io/map_yaml.hpp"
#include "pos/io/overrides.hpp"
#include "pos/io/run_config.hpp"

namespace {

template <class Load>
void attempt(Load load) {
  try {
    load();
  } catch (const pos::ConfigError&) {
    // The expected answer to a bad text; anything else escapes and is reported by the fuzzer.
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  attempt([&] {
    const auto run = pos::io::runConfigFrom(pos::io::parseYaml(text, "/site/run.yaml"), "/share");
    const auto again = pos::io::parseYaml(pos::io::resolvedYaml(run), "/site/run.yaml");
    if (pos::io::runConfigFrom(again, "/share") != run) __builtin_trap();
  });
  attempt([&] { (void)pos::io::readOptions(pos::io::parseYaml(text, "map.yaml"), pos::io::mapOptions()); });
  attempt([&] { (void)pos::io::applyOverrides(pos::io::parseYaml("a: [{name: b}]", "c.yaml"), {text}); });
  return 0;
}
