// Blocks drawn where they are inserted.
#include <Eigen/Geometry>
#include <cmath>

#include "dxf_records.hpp"
#include "pos/core/error.hpp"

namespace pos::io::dxf {
namespace {

constexpr int kDeepest = 16;
constexpr std::size_t kMostSteps = 200'000;

Eigen::Affine3d placement(const Insert& insert, const Eigen::Vector3d& base, int column, int row) {
  const Eigen::Affine3d turned(Eigen::AngleAxisd(insert.rotation, Eigen::Vector3d::UnitZ()));
  Eigen::Affine3d placed = Eigen::Translation3d(insert.symbol.vertices.front().p) * turned *
                           Eigen::Translation3d(column * insert.column_step, row * insert.row_step, 0.0) *
                           Eigen::Scaling(insert.scale) * Eigen::Translation3d(-base);
  if (insert.mirrored) placed = Eigen::Scaling(Eigen::Vector3d(-1.0, 1.0, -1.0)) * placed;
  return placed;
}

/// Whether circles stay circles in plan.
bool keepsShape(const Eigen::Affine3d& placed) {
  const Eigen::Vector2d u = placed.linear().col(0).head<2>();
  const Eigen::Vector2d v = placed.linear().col(1).head<2>();
  return std::abs(u.norm() - v.norm()) <= 1e-6 * u.norm() && std::abs(u.dot(v)) <= 1e-6 * u.squaredNorm();
}

bool curved(const DxfEntity& entity) {
  if (entity.kind == DxfEntity::Kind::Circle) return true;
  for (const DxfVertex& vertex : entity.vertices) {
    if (vertex.bulge != 0.0) return true;
  }
  return false;
}

class Expander {
 public:
  Expander(const std::map<std::string, Block>& blocks, SkipList& skipped, const std::string& file)
      : blocks_(blocks), skipped_(skipped), file_(file) {}

  void draw(const Content& content, const Eigen::Affine3d& placed, const std::string& layer, int depth) {
    std::size_t next = 0;
    for (std::size_t i = 0; i <= content.entities.size(); ++i) {
      for (; next < content.inserts.size() && content.inserts[next].first == i; ++next) {
        draw(content.inserts[next].second, placed, layer, depth);
      }
      if (i < content.entities.size()) draw(content.entities[i], placed, layer, depth);
    }
  }

  std::vector<DxfEntity> take() { return std::move(entities_); }

 private:
  void draw(DxfEntity entity, const Eigen::Affine3d& placed, const std::string& layer, int depth) {
    if (depth > 0) countStep(entity.vertices.size());
    if (depth > 0 && entity.layer == "0") entity.layer = layer;
    if (curved(entity) && !keepsShape(placed)) {
      skipped_.add(entity.layer, entity.type, "an arc in a block that is stretched", entity.line);
      return;
    }
    const bool flipped = placed.linear().topLeftCorner<2, 2>().determinant() < 0.0;
    for (DxfVertex& vertex : entity.vertices) {
      vertex.p = placed * vertex.p;
      if (flipped) vertex.bulge = -vertex.bulge;
      if (!vertex.p.allFinite()) {
        skipped_.add(entity.layer, entity.type, "damaged: a block enlarged beyond measure", entity.line);
        return;
      }
    }
    entity.radius *= placed.linear().col(0).norm();
    entity.block_part = depth > 0;
    entities_.push_back(std::move(entity));
  }

  void draw(const Insert& insert, const Eigen::Affine3d& placed, const std::string& layer, int depth) {
    const std::string own = depth > 0 && insert.symbol.layer == "0" ? layer : insert.symbol.layer;
    const auto block = blocks_.find(insert.symbol.block);
    if (block == blocks_.end() || depth >= kDeepest) {
      skipped_.add(own, "INSERT",
                   block == blocks_.end() ? "of a block that is not there" : "blocks nested too deep",
                   insert.symbol.line);
      return;
    }
    for (int row = 0; row < insert.rows; ++row) {
      for (int column = 0; column < insert.columns; ++column) {
        countStep(1);
        const Eigen::Affine3d here = placed * placement(insert, block->second.base, column, row);
        DxfEntity symbol = insert.symbol;
        symbol.vertices = {{here * block->second.base, 0.0}};
        symbol.layer = own;
        symbol.block_part = depth > 0;
        if (symbol.vertices.front().p.allFinite()) entities_.push_back(std::move(symbol));
        draw(block->second.content, here, own, depth + 1);
      }
    }
  }

  void countStep(std::size_t by) {
    steps_ += by;
    if (steps_ <= kMostSteps) return;
    throw DataError(
        Complaint{.what = "the drawing's blocks multiply to more parts than can be read",
                  .place = {.file = file_},
                  .expected = "at most 200 000 points",
                  .suggestion = "delete hatching and symbol blocks from the drawing, then save it again"});
  }

  const std::map<std::string, Block>& blocks_;
  SkipList& skipped_;
  const std::string& file_;
  std::vector<DxfEntity> entities_;
  std::size_t steps_ = 0;
};

}  // namespace

std::vector<DxfEntity> expanded(const Content& content, const std::map<std::string, Block>& blocks,
                                SkipList& skipped, const std::string& file) {
  Expander expander(blocks, skipped, file);
  expander.draw(content, Eigen::Affine3d::Identity(), "0", 0);
  return expander.take();
}

}  // namespace pos::io::dxf
