/// libFuzzer entry: any bytes as a DXF drawing, as GeoJSON or as a mapping of surveyor's tables become a map
/// or throw pos::Error; what became a map can be written again.

#include <cstdint>
#include <string>

#include "pos/core/error.hpp"
#include "pos/io/dxf_map.hpp"
#include "pos/io/map_geojson.hpp"
#include "pos/io/map_tables.hpp"

namespace {

template <class Load>
void attempt(Load load) {
  try {
    load();
  } catch (const pos::Error&) {
    // The expected answer to a bad text; anything else escapes and is reported by the fuzzer.
  }
}

void drawing(const std::string& text) {
  using Kind = pos::io::DxfLayerKind;
  const auto read = pos::io::parseDxf(text, "plan.dxf");
  pos::io::DxfImportRules rules;
  rules.metres_per_unit = 1.0;
  for (const Kind kind : {Kind::Roadway, Kind::Anchor, Kind::RefugeChamber, Kind::Portal}) {
    rules.layers = {{"A*", Kind::Anchor}, {"C*", Kind::PassingChamber}, {"*", kind}};
    attempt([&] {
      const auto import = pos::io::mapFromDxf(read, rules);
      (void)pos::io::mapDxf(import.map);
    });
    rules.layers.erase(rules.layers.begin(), rules.layers.begin() + 2);
    attempt([&] { (void)pos::io::mapFromDxf(read, rules); });
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  attempt([&] { drawing(text); });
  attempt([&] { (void)pos::io::mapGeoJson(pos::io::parsedGeoJson(text, "mine.geojson").file); });
  attempt([&] { (void)pos::io::parseTableMapping(text, "tables.yaml"); });
  return 0;
}
