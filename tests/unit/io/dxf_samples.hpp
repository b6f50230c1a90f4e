#pragma once
/// Pieces of DXF text for tests.

#include <string>

namespace pos::io::dxf {

inline std::string number(double value) {
  return std::to_string(value);
}

inline std::string line(const std::string& layer, double x0, double y0, double x1, double y1) {
  return "0\nLINE\n8\n" + layer + "\n10\n" + number(x0) + "\n20\n" + number(y0) + "\n11\n" + number(x1) +
         "\n21\n" + number(y1) + "\n";
}

inline std::string point(const std::string& layer, double x, double y, double z = 0.0) {
  return "0\nPOINT\n8\n" + layer + "\n10\n" + number(x) + "\n20\n" + number(y) + "\n30\n" + number(z) + "\n";
}

inline std::string text(const std::string& layer, double x, double y, const std::string& words) {
  return "0\nTEXT\n8\n" + layer + "\n10\n" + number(x) + "\n20\n" + number(y) + "\n40\n1\n1\n" + words + "\n";
}

inline std::string block(const std::string& name, double x, double y, const std::string& entities) {
  return "0\nBLOCK\n8\n0\n2\n" + name + "\n10\n" + number(x) + "\n20\n" + number(y) + "\n" + entities +
         "0\nENDBLK\n8\n0\n";
}

inline std::string file(const std::string& entities, const std::string& blocks = {}) {
  return "0\nSECTION\n2\nBLOCKS\n" + blocks + "0\nENDSEC\n0\nSECTION\n2\nENTITIES\n" + entities +
         "0\nENDSEC\n0\nEOF\n";
}

}  // namespace pos::io::dxf
