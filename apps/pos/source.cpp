#include "source.hpp"

#include "pos/sim/simulation.hpp"

namespace pos::app {
namespace {

class Recording : public Source {
 public:
  explicit Recording(const std::filesystem::path& file) : log_(io::openLog(file.string())) {}
  std::optional<Measurement> next() override { return log_.reader->next(); }
  io::LogEnd end() const override { return log_.reader->end(); }
  io::LogTally tally() const override { return log_.reader->tally(); }
  std::string note() const override { return log_.note; }

 private:
  io::OpenedLog log_;
};

class Simulated : public Source {
 public:
  explicit Simulated(const Inputs& inputs)
      : simulation_(*inputs.scenario, inputs.scenario_map, inputs.config.seed) {}

  std::optional<Measurement> next() override {
    auto delivery = simulation_.next();
    if (!delivery) return std::nullopt;
    ++delivered_;
    return std::move(delivery->measurement);
  }
  io::LogEnd end() const override {
    return {.damaged = false, .objects = delivered_, .byte = 0, .message = {}};
  }
  io::LogTally tally() const override { return {}; }

 private:
  sim::Simulation simulation_;
  std::uint64_t delivered_ = 0;
};

}  // namespace

std::unique_ptr<Source> openSource(const Inputs& inputs) {
  if (inputs.scenario) return std::make_unique<Simulated>(inputs);
  return std::make_unique<Recording>(inputs.config.log->file);
}

}  // namespace pos::app
