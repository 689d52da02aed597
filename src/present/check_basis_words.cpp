#include <fmt/format.h>
#include <fmt/ranges.h>

#include <variant>

#include "base/quantity.h"
#include "check/limit.h"
#include "derate/committed_table.h"
#include "motor/lint.h"
#include "present/check_words.h"
#include "present/derating.h"

namespace heatsoak::present {
namespace {

std::string say(const std::monostate& /*of*/, const check::Outcome& /*outcome*/) { return {}; }

std::string say(const check::PeakBasis& of, const check::Outcome& /*outcome*/) {
  return fmt::format(
      "percentile {:.1f} °C, its bound with {:.3g} % confidence {:.1f} °C; nominal {:.1f} °C, median {:.1f} °C, {} samples, {}", of.p95_C,
      100.0 * check::kBoundConfidence_share, of.bound_C, of.nominal_C, of.median_C, of.samples, of.wheel);
}

std::string say(const check::ShareBasis& of, const check::Outcome& outcome) {
  std::string text = fmt::format("{} of {} samples over, bound of {:.3g} % confidence{}", of.over, of.samples,
                                 100.0 * check::kBoundConfidence_share, of.games ? fmt::format(" by {} games", *of.games) : "");
  if (outcome.passed()) {
    return text;
  }
  return text + (of.samples_needed ? fmt::format("; {} samples or more could meet {} % with this share", *of.samples_needed,
                                                 base::significant(100.0 * of.limit_share, 3))
                                   : "; no number of samples can meet the limit with this share");
}

std::string say(const check::MarginBasis& of, const check::Outcome& /*outcome*/) {
  return fmt::format("the duty takes {:.2f} A rms, nominal motor", of.current_rms_A);
}

std::string place_words(const derate::TablePlace& place) {
  return place.difference_A == 0.0 ? std::string()
                                   : fmt::format("at {:.0f} rad/s, stator {:.0f} °C, winding {:.0f} °C: {:.3f} A, a fresh table {:.3f} A",
                                                 place.speed_rad_per_s, place.stator_C, place.winding_C, place.committed_A, place.fresh_A);
}

/// Returns a remark on the version if a limit of a committed table does not hold.
std::string version_words(const std::string& other_version, const check::Outcome& outcome) {
  return outcome.passed() || other_version.empty() ? std::string() : "; " + upgrade_words(other_version);
}

std::string say(const check::ExcessBasis& of, const check::Outcome& outcome) {
  std::string text = place_words(of.excess);
  if (of.lost_A > 0.0) {
    text += fmt::format("{}allows up to {:.3f} A less elsewhere", text.empty() ? "" : "; ", of.lost_A);
  }
  return text.empty() ? fmt::format("within {} of a fresh table", derate::kIgnored) : text + version_words(of.other_version, outcome);
}

std::string say(const check::LostBasis& of, const check::Outcome& outcome) {
  return place_words(of.lost) + version_words(of.other_version, outcome);
}

std::string say(const check::TimeAboveBasis& of, const check::Outcome& /*outcome*/) {
  return fmt::format("counted above {:.0f} °C over {:.0f} s; the nominal winding reaches {:.1f} °C", of.temperature_C, of.duration_s,
                     of.nominal_peak_C);
}

std::string say(const check::GuardShareBasis& of, const check::Outcome& /*outcome*/) {
  return fmt::format("{:.1f} of {:.0f} s; its observer reached {:.1f} °C, the winding {:.1f} °C", of.limited_s, of.duration_s,
                     of.observer_peak_C, of.winding_peak_C);
}

std::string say(const check::GuardChargeBasis& of, const check::Outcome& /*outcome*/) {
  return fmt::format("the guard would limit for {:.1f} of {:.0f} s", of.limited_s, of.duration_s);
}

std::string say(const check::LintBasis& of, const check::Outcome& /*outcome*/) {
  return fmt::format("{}: {}", base::to_string(of.first.at), motor::words_of(of.first));
}

std::string say(const check::RankBasis& of, const check::Outcome& /*outcome*/) {
  return fmt::format("of {} motors{}{}", of.motors, of.better.empty() ? "" : "; before it: ", fmt::join(of.better, ", "));
}

std::string say(const check::CoreSizeBasis& of, const check::Outcome& /*outcome*/) {
  return fmt::format("{} files, guard table of {} bytes", of.files, of.table_bytes);
}

std::string say(const check::ForecastBasis& of, const check::Outcome& /*outcome*/) {
  std::string text;
  for (const check::ForecastBasis::Signal& each : of.signals) {
    text += fmt::format("{}{}: {} {:.2f} K rms, {:.1f} K at most", text.empty() ? "" : "; ", each.run, each.signal, each.rmse_K,
                        each.largest_K);
  }
  return text;
}

std::string compared_words(const check::NumberBasis& of, const check::ThresholdType& type) {
  const auto end = [&type](const std::optional<double>& value) { return value ? check::shown(*value, type) : "unknown"; };
  switch (of.compared) {
    case check::Compared::interval:
      return fmt::format("{}, its {:.3g} % interval {} to {}", check::shown(of.value, type), 100.0 * (1.0 - select::kError_share),
                         end(of.interval.low), end(of.interval.high));
    case check::Compared::percentile:
      return "the percentile itself is compared: the answer has no interval for it";
    case check::Compared::probability:
      return "the probability itself is compared: the answer has no interval for it";
    case check::Compared::nominal_time:
      return "the time of the nominal motor is compared";
    case check::Compared::nominal:
      return "the nominal value is compared";
    case check::Compared::number:
      return {};
  }
  return {};
}

std::string say(const check::NumberBasis& of, const check::Outcome& outcome) {
  const std::string compared = compared_words(of, *outcome.limit.type);
  const std::string place = of.numbers > 1 ? fmt::format("{}, of {} numbers", of.name, of.numbers) : "";
  return fmt::format("{}{}{}", place, place.empty() || compared.empty() ? "" : "; ", compared);
}

}  // namespace

std::string basis_words(const check::Outcome& outcome) {
  return outcome.measured ? std::visit([&outcome](const auto& each) { return say(each, outcome); }, outcome.measured->basis) : "";
}

}  // namespace heatsoak::present
