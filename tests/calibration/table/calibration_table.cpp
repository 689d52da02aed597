// Scores the calibration on synthetic motors with known parameters and prints tables.
//   heatsoak_calibration_table [CASES [both|two|stator|lost|resistance|local [FIRST_SEED]]]
//   "local": the information that four runs contain about each parameter at the truth, without any prior, compared with a prototype of the
//   method.
#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <map>
#include <string>

#include "../../support/study_words.h"
#include "base/parallel.h"
#include "study.h"

namespace {

using namespace heatsoak;
using namespace heatsoak::calibration::study;

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

/// Returns the 95 % interval of a share (Clopper and Pearson 1934).
std::pair<double, double> bounds_of(int hits, int count) {
  const auto quantile = [](double a, double b, double p) { return boost::math::quantile(boost::math::beta_distribution<>(a, b), p); };
  return {hits == 0 ? 0.0 : quantile(hits, count - hits + 1.0, 0.025), hits == count ? 1.0 : quantile(hits + 1.0, count - hits, 0.975)};
}

void tabulate(const std::string& title, const Sheet& sheet, const Case& like, int cases, std::uint64_t first_seed) {
  std::vector<CaseResult> results(static_cast<std::size_t>(cases));
  base::in_parallel(results.size(), 0, [&](std::size_t i) {
    Case one = like;
    one.seed = first_seed + i;
    results[i] = calibrate_case(sheet, one);
  });
  fmt::print("\n{}: {} cases of {} runs\n{:36} {:>8} {:>13} {:>10} {:>10} {:>9} {:>10} {:>9}\n", title, cases, like.runs, "parameter",
             "covered", "95 % of that", "median err", "90 % err", "rms z", "half width", "averaged");
  std::vector<double> seconds_s;
  for (std::size_t f = 0; f < results.front().marks.size(); ++f) {
    // `averaged`: factor by which averaging over the unknown heat widens the interval, compared with the most probable one.
    std::vector<double> errors, widths, averaged;
    int covered = 0;
    double squares = 0.0;
    for (const CaseResult& each : results) {
      const Mark& mark = each.marks[f];
      covered += mark.is_covered() ? 1 : 0;
      errors.push_back(std::abs(mark.error_ratio()));
      const double half = 0.5 * std::log(mark.parameter.high / mark.parameter.low);
      widths.push_back(half);
      squares += std::pow(std::log(mark.parameter.value / mark.truth) / (half / 1.96), 2);
      const Eigen::VectorXd& exponents = each.calibration.motor_model.parameters[f].exponents;
      const estimation::Fit& fit = each.calibration.fit;
      averaged.push_back(std::sqrt(exponents.dot(fit.covariance * exponents) / exponents.dot(fit.covariance_at_flux * exponents)));
    }
    const auto [low, high] = bounds_of(covered, cases);
    std::ranges::sort(errors);
    fmt::print("{:36} {:7.1f}% {:5.1f} …{:5.1f}% {:9.2f}% {:9.2f}% {:9.2f} {:9.2f}% {:9.2f}\n", results.front().marks[f].name,
               100.0 * covered / cases, 100.0 * low, 100.0 * high, 100.0 * median(errors),
               100.0 * errors[static_cast<std::size_t>(0.9 * cases)], std::sqrt(squares / cases), 100.0 * median(widths), median(averaged));
  }
  std::vector<double> flux_W, time_s;
  for (const CaseResult& each : results) {
    seconds_s.push_back(each.seconds_s);
    flux_W.push_back(each.calibration.fit.flux.rms_W.front());
    time_s.push_back(each.calibration.fit.flux.time_scale_s);
  }
  fmt::print("median time of a calibration {:.2f} s; unknown heat found: median {:.3f} W over {:.0f} s\n", median(seconds_s),
             median(flux_W), median(time_s));
  std::fflush(stdout);
}

struct LocalRow {
  bool winding_is_sensed;
  double flux_W;
  const char* prototype;  ///< prototype's values for ln C_w, ln R_ws, ln C_s, ln R_sa
};

/// Prints standard deviations from the whitened derivatives, with known flux and noise.
void tabulate_local(std::uint64_t seed) {
  // This value makes the first row agree. The note does not state the load of its prototype.
  constexpr double kMild_A = 6.8;
  fmt::print(
      "\nstandard deviation of the logarithm in %, four runs of 30 min, no prior, flux of 180 s known\n{:24} {:>8} {:>8} {:>8} {:>8}   "
      "{}\n",
      "sensors, flux", "C_w", "R_ws", "C_s", "R_sa", "prototype: C_w, R_ws, C_s, R_sa");
  const estimation::TwoNodeTruth truth;
  const estimation::Model model = estimation::two_node_model(truth, 1e3);
  std::vector<int> wanted;
  for (const estimation::FreeParameter& parameter : model.free) {
    wanted.push_back(parameter.place);
  }
  for (const auto& [winding_is_sensed, flux_W, prototype] :
       {LocalRow{true, 0.0, "0.14, 0.07, 0.15, 0.03"}, LocalRow{true, 0.05, "0.18-0.24, 0.2, 0.44, 0.6-0.7"},
        LocalRow{false, 0.0, "6-8, 5-7, 1.3-1.7, 0.15"}, LocalRow{false, 0.05, "37-40, 30-33, 7.5, 1.1"}}) {
    std::vector<estimation::RunEvidence> all;
    for (std::uint64_t r = 0; r < 4; ++r) {
      estimation::LogMaking making;
      making.winding_is_sensed = winding_is_sensed;
      making.outlier_share = making.dropout_share = 0.0;
      making.largest_current_A = kMild_A;
      const estimation::MeasuredRun run = estimation::generated_run(truth, making, seed, r);
      const estimation::RunStart start = estimation::start_of(model.network, run);
      const estimation::LinearisedRun line =
          estimation::linearise(model.network, model.values, wanted, model.flux_nodes,
                                {start.state_C.data(), static_cast<std::size_t>(start.state_C.size())}, run);
      estimation::SensorNoise noise;
      for (const estimation::Sensor& sensor : run.sensors) {
        noise.noise_K.push_back(std::hypot(making.noise_K, sensor.step_K / std::sqrt(12.0)));
      }
      all.push_back(estimation::run_evidence(line, estimation::by_theta(model, model.theta(), line.by_parameter),
                                             estimation::Whitening(line, {{flux_W, flux_W}, 180.0}, noise),
                                             {start.prior_C - start.state_C, start.prior_sd_K}));
    }
    const estimation::LinearFit fit = estimation::linear_fit(all, Eigen::VectorXd::Zero(4), Eigen::MatrixXd::Zero(4, 4));
    const Eigen::VectorXd sd = 100.0 * fit.covariance.diagonal().cwiseSqrt();
    fmt::print("{:24} {:8.2f} {:8.2f} {:8.2f} {:8.2f}   {}\n",
               fmt::format("{}, {:g} W", winding_is_sensed ? "winding, stator" : "stator", flux_W), sd[0], sd[1], sd[2], sd[3], prototype);
  }
}

int run(const StudyWords& words) {
  const auto cases = static_cast<int>(words.whole(0, "CASES", 1, 300));
  const std::string which = words.one_of(1, {"both", "two", "stator", "lost", "resistance", "local"});
  const std::uint64_t first_seed = words.whole(2, "FIRST_SEED", 0, 1);
  if (which.empty() || which == "both") {
    tabulate("winding and stator sensed", {}, {}, cases, first_seed);
  }
  if (which.empty() || which == "two") {
    Case like;
    like.runs = 2;
    tabulate("winding and stator sensed", {}, like, cases, first_seed);
  }
  if (which.empty() || which == "stator") {
    Case like;
    like.making.winding_is_sensed = false;
    tabulate("only the stator sensed", {}, like, cases, first_seed);
  }
  if (which.empty() || which == "lost") {
    Case like;
    like.making.lost_row_share = 0.05;
    tabulate("winding and stator sensed, 5 % of the rows lost", {}, like, cases, first_seed);
  }
  if (which.empty() || which == "resistance") {
    tabulate("resistance to 5 %", {.truth = {}, .resistance_spread = ", tolerance = \"5 %\""}, {}, cases, first_seed);
  }
  if (which.empty() || which == "local") {
    tabulate_local(first_seed);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  constexpr const char* kUsage =
      "usage: heatsoak_calibration_table [CASES [both|two|stator|lost|resistance|local [FIRST_SEED]]]\n\n"
      "  CASES       per table, 300 without it\n"
      "  both …      one table instead of all\n"
      "  FIRST_SEED  1 without it\n";
  return run_study(argc, argv, kUsage, 3, run);
}
