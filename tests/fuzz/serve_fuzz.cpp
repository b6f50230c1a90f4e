/// libFuzzer entry: any bytes as the target of a request, a command, a line of a live feed or a map to be
/// checked give an answer or throw pos::Error.

#include <cstdint>
#include <string>

#include "pos/core/error.hpp"
#include "pos/io/json_lines.hpp"
#include "pos/serve/command.hpp"
#include "pos/serve/map_service.hpp"
#include "pos/serve/request.hpp"

namespace {

template <class Work>
void attempt(Work work) {
  try {
    work();
  } catch (const pos::Error&) {
    // The expected answer to a bad text; anything else escapes and is reported by the fuzzer.
  }
}

void stayInside(const pos::serve::Target& target) {
  for (const std::string& part : target.path) {
    if (part.empty() || part == ".." || part == "." || part.find('/') != std::string::npos) __builtin_trap();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  attempt([&] { stayInside(pos::serve::parsedTarget(text)); });
  attempt([&] { (void)pos::serve::parsedCommand(text); });
  attempt([&] {
    const pos::Measurement measurement = pos::io::measurementFrom(text, "feed");
    if (pos::defect(measurement)) __builtin_trap();
    (void)pos::io::jsonLine(measurement);
  });
  pos::io::LineCutter cutter;
  const auto ignore = [](const pos::io::LineCutter::Line&) {};
  cutter.feed(text, ignore);
  cutter.finish(ignore);
  const pos::serve::MapService service("none.yaml", pos::serve::MapService::Access::ReadOnly);
  attempt([&] { (void)service.check(text); });
  return 0;
}
