#include <array>
#include <charconv>
#include <cmath>
#include <set>

#include "pos/core/chi_square.hpp"
#include "pos/report/campaign_files.hpp"

namespace pos::report {
namespace {

/// The shortest text that reads back as the same number; empty for one that is not finite.
std::string cell(double value) {
  if (!std::isfinite(value)) return "";
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end.ptr};
}

std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c == '\n' || c == '\r' ? ' ' : c;
  }
  return quoted + "\"";
}

/// Two cells, both empty where there is no run to give bounds.
std::string boundCells(std::size_t runs, int dof) {
  if (runs == 0) return ",";
  const Interval bounds = meanChiSquareBounds(0.95, dof, static_cast<double>(runs));
  return cell(bounds.low) + "," + cell(bounds.high);
}

}  // namespace

std::string campaignCsv(const eval::CampaignSummary& campaign) {
  std::string csv = "estimator,metric,count,mean,std,median,min,max,worst,worst_run,worst_seed\n";
  for (const eval::EstimatorOverRuns& estimator : campaign.estimators) {
    for (const auto& [name, figures] : estimator.metrics) {
      csv += cell(estimator.name) + "," + cell(name) + "," + std::to_string(figures.count);
      for (const double value :
           {figures.mean, figures.std, figures.median, figures.min, figures.max, figures.worst}) {
        csv += "," + cell(value);
      }
      const eval::CampaignRow& worst = campaign.rows[figures.worst_row];
      csv += "," + std::to_string(worst.run) + "," + std::to_string(worst.seed) + "\n";
    }
  }
  return csv;
}

std::string runsCsv(const eval::CampaignSummary& campaign) {
  std::set<std::string> names;
  for (const eval::EstimatorOverRuns& estimator : campaign.estimators) {
    for (const auto& [name, values] : estimator.values) names.insert(name);
  }
  std::string csv = "run,seed,estimator";
  for (const std::string& name : names) csv += "," + cell(name);
  csv += "\n";
  for (std::size_t row = 0; row < campaign.rows.size(); ++row) {
    for (const eval::EstimatorOverRuns& estimator : campaign.estimators) {
      csv += std::to_string(campaign.rows[row].run) + "," + std::to_string(campaign.rows[row].seed) + "," +
             cell(estimator.name);
      for (const std::string& name : names) {
        const auto values = estimator.values.find(name);
        csv += "," + (values == estimator.values.end() ? std::string() : cell(values->second[row]));
      }
      csv += "\n";
    }
  }
  return csv;
}

std::string momentsCsv(const eval::CampaignSummary& campaign) {
  std::string csv =
      "estimator,t_s,runs,rmse_xy_m,nees_runs,anees_xy,anees_xy_low,anees_xy_high,nees_pose_runs,anees_pose,"
      "anees_pose_low,anees_pose_high,nis_per_dof\n";
  for (const eval::EstimatorOverRuns& estimator : campaign.estimators) {
    std::size_t bound_runs = 0;
    std::size_t bound_pose_runs = 0;
    std::string bounds = ",";
    std::string pose_bounds = ",";
    for (const eval::MomentOverRuns& moment : estimator.moments) {
      if (moment.nees_runs != bound_runs) bounds = boundCells(bound_runs = moment.nees_runs, 2);
      if (moment.nees_pose_runs != bound_pose_runs)
        pose_bounds = boundCells(bound_pose_runs = moment.nees_pose_runs, 3);
      csv += cell(estimator.name) + "," + cell(moment.t) + "," + std::to_string(moment.runs) + "," +
             cell(moment.rmse_xy) + "," + std::to_string(moment.nees_runs) + "," + cell(moment.anees_xy) +
             "," + bounds + "," + std::to_string(moment.nees_pose_runs) + "," + cell(moment.anees_pose) +
             "," + pose_bounds + "," + (moment.nis_dof > 0.0 ? cell(moment.nis / moment.nis_dof) : "") + "\n";
    }
  }
  return csv;
}

}  // namespace pos::report
