#include "serve_playing.hpp"

namespace pos::app {

std::unique_ptr<Pass> passOnStage(const Inputs& inputs, const io::RunFolder* folder, Stage& stage,
                                  serve::ConnectionMonitor& monitor, const Moment& moment) {
  auto pass = std::make_unique<Pass>(inputs, folder);
  std::vector<Recorder>& recorders = pass->recorders();
  for (std::size_t i = 0; i < recorders.size(); ++i) {
    recorders[i].tell(
        {.verdict =
             [&stage, &monitor, moment, i](const Measurement& measurement, const IngestReport& report) {
               stage.verdict(i, measurement, report);
               if (i == 0) monitor.judged(measurement, report.verdict, moment(measurement));
             },
         .estimate =
             [&stage, i](const Estimate& estimate, const std::optional<interval::IntervalBelief>& belief) {
               stage.estimate(i, estimate, belief);
             }});
  }
  pass->onEvent([&stage](const io::RunEvent& event) { stage.event(event); });
  return pass;
}

void showModes(Pass& pass, Stage& stage) {
  for (std::size_t i = 0; i < pass.recorders().size(); ++i)
    stage.modes(i, serve::modesOf(pass.recorders()[i].diagnostics()));
}

}  // namespace pos::app
