#include "recording/sensor_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>

#include "recording/quantities.h"
#include "recording/row_order.h"
#include "recording/spread.h"

namespace heatsoak::recording {
namespace {

constexpr std::size_t kEnoughBlocks = 10;
constexpr std::span kWindingHeats = std::span(kHeatColumns).first<kWindingHeatColumns>();
constexpr std::span kHeats = std::span(kHeatColumns).first<kHeatColumnsZeroAtRest>();

/// Returns the first of these channels that the log has, even if it is constant; nullptr if there is none.
const Channel* first_of(const Recording& recording, std::span<const std::string_view> keys) {
  for (const std::string_view key : keys) {
    if (const Channel* const channel = recording.find(key)) {
      return channel;
    }
  }
  return nullptr;
}

/// Changes of a channel over blocks of time, with the mean heat and speed of each block.
struct Blocks {
  std::vector<double> change_K;
  std::vector<double> rate_K_per_s;
  std::vector<double> heat;
  std::vector<double> speed_rad_per_s;  ///< magnitude; empty if the log has no speed
};

void subtract_line(std::span<const double> x, std::vector<double>& y) {
  const Regression line = regress(x, y);
  for (std::size_t i = 0; i < y.size(); ++i) {
    y[i] -= line.intercept + line.slope * x[i];
  }
}

double variance(std::span<const double> values) {
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  return std::accumulate(values.begin(), values.end(), 0.0,
                         [mean](double sum, double each) { return sum + (each - mean) * (each - mean); }) /
         static_cast<double>(values.size());
}

class Places {
 public:
  Places(const Recording& recording, std::span<const ChannelQuality> channels)
      : recording_(recording),
        channels_(channels),
        winding_(recording.find("winding_C")),
        stator_(recording.find("stator_C")),
        ambient_(recording.find(kAmbientColumn)),
        speed_(recording.find(column_of(base::Signal::speed))) {
    block_s_ = std::max(5.0 * usual_period_s(recording.time_s), (recording.time_s.back() - recording.time_s.front()) / 200.0);
    find_rests();
  }

  std::vector<Suspicion> run() {
    ambient_against_motor();
    signs();
    if (moves(winding_) && moves(stator_)) {
      swapped_by_heat();
      swapped_by_cooling();
      swapped_at_standstill();
    }
    return std::move(found_);
  }

 private:
  [[nodiscard]] const ChannelQuality& quality(const Channel& channel) const {
    return *std::ranges::find_if(channels_, [&](const ChannelQuality& each) { return each.quantity.key == channel.quantity.key; });
  }
  [[nodiscard]] bool moves(const Channel* channel) const { return channel != nullptr && !quality(*channel).is_constant(); }

  void find_rests() {
    constexpr double kLittleHeat = 0.01;  // W or A²
    constexpr double kLittleHeat_share = 1e-3;
    constexpr double kLittleSpeed_rad_per_s = 1.0;
    rests_.assign(recording_.rows(), 1);
    if (const Channel* const input = first_of(recording_, kHeats)) {
      const std::vector<double> heat = relative_heat(*input);
      const double little = std::max(kLittleHeat, kLittleHeat_share * percentile(heat, 1.0));
      std::ranges::transform(heat, rests_.begin(), [little](double each) { return std::abs(each) < little ? 1 : 0; });
    }
    for (std::size_t row = 0; speed_ != nullptr && row < rests_.size(); ++row) {
      rests_[row] = rests_[row] != 0 && std::abs(speed_->values[row]) < kLittleSpeed_rad_per_s ? 1 : 0;
    }
  }

  void ambient_against_motor() {
    constexpr double kBelow_K = 3.0;
    for (const Channel& channel : recording_.channels) {
      if (ambient_ == nullptr || channel.quantity.kind != QuantityKind::temperature || recording_.find("coolant_C") != nullptr ||
          !moves(&channel)) {
        continue;
      }
      std::vector<double> above_K;
      for (std::size_t i = 0; i < recording_.rows(); ++i) {
        above_K.push_back(channel.values[i] - ambient_->values[i]);
      }
      if (middle_of(above_K) < -kBelow_K && !was_brought_in_cold(channel, above_K)) {
        found_.emplace_back(AmbientAboveMotor{channel.quantity.key, -middle_of(above_K)});
      }
    }
  }

  /// True if the motor started colder than the air and then warmed up towards it, also without heat.
  [[nodiscard]] bool was_brought_in_cold(const Channel& channel, std::span<const double> above_K) const {
    constexpr double kColdest_K = -40.0;
    constexpr double kWarms_K = 1.0;
    const double start_K = coolest_at_start({channel.quantity, {above_K.begin(), above_K.end()}});
    double rises_in_rests_K = 0.0;
    double rises_K = 0.0;
    std::size_t rests = 0;
    for_each_block(channel, [&](std::size_t from, std::size_t to, double change_K) {
      const bool is_rest = std::all_of(rests_.begin() + static_cast<std::ptrdiff_t>(from), rests_.begin() + static_cast<std::ptrdiff_t>(to),
                                       [](char each) { return each != 0; });
      if (above_K[from] < 0.0) {
        rises_K += change_K;
        rises_in_rests_K += is_rest ? change_K : 0.0;
        rests += is_rest ? 1 : 0;
      }
    });
    return start_K > kColdest_K && start_K < -kWarms_K && (rests >= kEnoughBlocks ? rises_in_rests_K : rises_K) > kWarms_K;
  }

  /// Calls take(from, to, change_K) for each block whose end rows have values.
  template <class Take>
  void for_each_block(const Channel& channel, Take take) const {
    for (const auto& [begin, end] : recording_.runs()) {
      std::size_t from = begin;
      for (std::size_t row = begin; row < end; ++row) {
        if (recording_.time_s[row] - recording_.time_s[from] >= block_s_) {
          if (const double change_K = channel.values[row] - channel.values[from]; !std::isnan(change_K)) {
            take(from, row, change_K);
          }
          from = row;
        }
      }
    }
  }

  [[nodiscard]] Blocks blocks_of(const Channel& channel, std::span<const double> heat) const {
    Blocks blocks;
    for_each_block(channel, [&](std::size_t from, std::size_t to, double change_K) {
      double heat_sum = 0.0;
      double speed_sum_rad_per_s = 0.0;
      for (std::size_t row = from; row < to; ++row) {
        heat_sum += heat[row];
        speed_sum_rad_per_s += speed_ != nullptr ? std::abs(speed_->values[row]) : 0.0;
      }
      if (std::isnan(heat_sum) || std::isnan(speed_sum_rad_per_s)) {
        return;
      }
      const auto rows = static_cast<double>(to - from);
      blocks.change_K.push_back(change_K);
      blocks.rate_K_per_s.push_back(change_K / (recording_.time_s[to] - recording_.time_s[from]));
      blocks.heat.push_back(heat_sum / rows);
      if (speed_ != nullptr) {
        blocks.speed_rad_per_s.push_back(speed_sum_rad_per_s / rows);
      }
    });
    return blocks;
  }

  /// Detects a wrong sign: the temperature falls while heated and rises at rest, by a large part of its range. If the heat hardly varies,
  /// a motor near steady state with rising resistance may look the same.
  void signs() {
    const Channel* const input = first_of(recording_, kHeats);
    if (!moves(input)) {
      return;
    }
    const std::vector<double> heat = relative_heat(*input);
    for (const Channel* channel : {winding_, stator_}) {
      if (!moves(channel)) {
        continue;
      }
      const Blocks blocks = blocks_of(*channel, heat);
      constexpr double kHeats_share = 0.5;
      constexpr double kRests_share = 0.3;
      const double top = percentile(blocks.heat, 0.95);
      double falls_K = 0.0;
      double rises_K = 0.0;
      for (std::size_t i = 0; i < blocks.heat.size(); ++i) {
        falls_K -= blocks.heat[i] > kHeats_share * top ? blocks.change_K[i] : 0.0;
        rises_K += std::abs(blocks.heat[i]) < kRests_share * top ? blocks.change_K[i] : 0.0;
      }
      constexpr double kMuch_share = 0.3;
      const double much_K = std::max({1.0, 5.0 * quality(*channel).noise, kMuch_share * swing(*channel)});
      if (blocks.heat.size() >= kEnoughBlocks && falls_K > much_K && rises_K > much_K &&
          regress(blocks.heat, blocks.rate_K_per_s).correlation_ratio < -0.5) {
        found_.emplace_back(FallsWhileHeated{channel->quantity.key, input->quantity.key});
      }
    }
  }

  /// Regression of a temperature's rate on the heat. If heat and speed are correlated, the effect of speed is removed first, because iron
  /// loss heats the stator.
  [[nodiscard]] Regression answer_of(const Channel& channel, std::span<const double> heat) const {
    Blocks blocks = blocks_of(channel, heat);
    if (speed_ != nullptr && regress(blocks.speed_rad_per_s, blocks.heat).correlation_ratio > 0.0) {
      constexpr double kLeastOwn_share = 0.05;
      const double all = variance(blocks.heat);
      subtract_line(blocks.speed_rad_per_s, blocks.heat);
      subtract_line(blocks.speed_rad_per_s, blocks.rate_K_per_s);
      if (variance(blocks.heat) < kLeastOwn_share * all) {
        return {};
      }
    }
    return regress(blocks.heat, blocks.rate_K_per_s);
  }

  void swapped_by_heat() {
    const Channel* const input = first_of(recording_, kWindingHeats);
    if (!moves(input)) {
      return;
    }
    // Without a logged speed the heat may be iron loss, with which both temperatures swing similarly.
    const double kSwing_ratio = speed_ != nullptr ? 1.1 : 1.25;
    const std::vector<double> heat = relative_heat(*input);
    const Regression of_winding = answer_of(*winding_, heat);
    const Regression of_stator = answer_of(*stator_, heat);
    if (of_stator.points >= kEnoughBlocks && of_stator.correlation_ratio > 0.3 && of_stator.slope > 1.3 * of_winding.slope &&
        swing(*stator_) > kSwing_ratio * swing(*winding_)) {
      found_.emplace_back(StatorRespondsFaster{input->quantity.key, swing(*stator_), swing(*winding_)});
    }
  }

  /// Detects swapped sensors in cool-downs. Without heat, the winding stays hotter than the stator, to which it loses its heat, and falls
  /// by more. A sensor offset is constant, so the difference must change in one direction from hot to cold.
  void swapped_by_cooling() {
    int swapped = 0;
    int sound = 0;
    double apart_K = 0.0;
    for (const auto& [begin, end] : recording_.runs()) {
      for (std::size_t row = begin; row < end; ++row) {
        std::vector<std::size_t> rows;
        for (; row < end && rests_[row] != 0; ++row) {
          if (std::isfinite(winding_->values[row]) && std::isfinite(stator_->values[row])) {
            rows.push_back(row);
          }
        }
        const Cooling cooling = cooling_over(rows);
        sound += cooling.verdict > 0 ? 1 : 0;
        swapped += cooling.verdict < 0 ? 1 : 0;
        apart_K = std::max(apart_K, cooling.stator_above_K);
      }
    }
    if (swapped > 0 && sound == 0) {
      found_.emplace_back(StatorHotterAtRest{apart_K});
    }
  }

  /// Detects swapped sensors at standstill: there is only copper loss, so the winding must warm up faster than the stator.
  void swapped_at_standstill() {
    const Channel* const input = first_of(recording_, kWindingHeats);
    if (speed_ == nullptr || input == nullptr || !found_.empty()) {
      return;
    }
    const std::vector<double> heat = relative_heat(*input);
    for (const auto& [begin, end] : recording_.runs()) {
      if (const std::optional<StatorLead> lead = lead_at_standstill(begin, end, heat)) {
        found_.emplace_back(StatorWarmsFirst{input->quantity.key, lead->stator_rise_K, lead->stator_ahead_K});
        return;
      }
    }
  }

  /// Medians over the samples in which the stator is clearly warmer than at the start.
  struct StatorLead {
    double stator_rise_K = 0.0;
    double stator_ahead_K = 0.0;  ///< temperature of the stator above the winding
  };
  /// Evaluates a run from its first row until the motor turns. Returns nothing if the stator does not clearly lead.
  [[nodiscard]] std::optional<StatorLead> lead_at_standstill(std::size_t begin, std::size_t end, std::span<const double> heat) const {
    constexpr double kStands_rad_per_s = 1.0;
    constexpr double kAlikeAtStart_K = 10.0;
    constexpr double kRises_K = 8.0;
    constexpr double kAhead_K = 4.0;
    constexpr double kAhead_share = 0.25;  // more than the gain of a sensor
    constexpr double kAlways_share = 0.9;
    constexpr std::size_t kFewestSamples = 15;
    std::vector<double> winding_C;
    std::vector<double> stator_C;
    double heat_sum = 0.0;
    for (std::size_t row = begin; row < end && std::abs(speed_->values[row]) < kStands_rad_per_s; ++row) {
      if (std::isfinite(winding_->values[row]) && std::isfinite(stator_->values[row])) {
        winding_C.push_back(winding_->values[row]);
        stator_C.push_back(stator_->values[row]);
      }
      heat_sum += std::isfinite(heat[row]) ? heat[row] : 0.0;
    }
    if (winding_C.size() < kFewestSamples || heat_sum <= 0.0) {
      return std::nullopt;
    }
    const double winding_start_C = middle_of(std::span(winding_C).first(3));
    const double stator_start_C = middle_of(std::span(stator_C).first(3));
    const double at_start_K = stator_start_C - winding_start_C;
    std::vector<double> rises_K;
    std::vector<double> ahead_K;
    for (std::size_t i = 0; i < winding_C.size(); ++i) {
      if (stator_C[i] - stator_start_C > kRises_K) {
        rises_K.push_back(stator_C[i] - stator_start_C);
        // An initial difference may be a sensor offset.
        ahead_K.push_back(stator_C[i] - winding_C[i] - std::max(0.0, at_start_K));
      }
    }
    if (std::abs(at_start_K) > kAlikeAtStart_K || ahead_K.size() < kFewestSamples || percentile(ahead_K, 1.0 - kAlways_share) < 0.0 ||
        middle_of(ahead_K) < std::max(kAhead_K, kAhead_share * middle_of(rises_K))) {
      return std::nullopt;
    }
    return StatorLead{middle_of(rises_K), middle_of(ahead_K) + std::max(0.0, at_start_K)};
  }

  struct Cooling {
    int verdict = 0;              ///< 1: correct, -1: swapped, 0: undecided
    double stator_above_K = 0.0;  ///< excess of the stator while hot, if swapped
  };
  [[nodiscard]] Cooling cooling_over(std::span<const std::size_t> rows) const {
    constexpr std::size_t kFewestRows = 15;
    constexpr std::size_t kFewestInAThird = 3;
    constexpr double kFalls_K = 8.0;
    constexpr double kStatorAbove_K = 1.0;
    constexpr double kMoreThanLag_K = 8.0;
    if (rows.size() < kFewestRows) {
      return {};
    }
    std::vector<double> stator_C;
    std::vector<double> mean_C;
    std::vector<double> apart_K;
    for (const std::size_t row : rows) {
      stator_C.push_back(stator_->values[row]);
      mean_C.push_back(0.5 * (winding_->values[row] + stator_->values[row]));
      apart_K.push_back(winding_->values[row] - stator_->values[row]);
    }
    const auto fall_K = [](std::span<const double> values) {
      const std::size_t few = std::max<std::size_t>(3, values.size() / 50);
      return middle_of(values.first(few)) - middle_of(values.last(few));
    };
    if (fall_K(stator_C) < kFalls_K || fall_K(mean_C) < kFalls_K) {
      return {};
    }
    // Thirds of the temperature drop, not of the time, because the last part of the time may be constant.
    const double hot_C = middle_of(std::span(mean_C).first(3));
    const double third_K = fall_K(mean_C) / 3.0;
    std::array<std::vector<double>, 3> apart_per_third_K;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double third = std::clamp(std::floor((hot_C - mean_C[i]) / third_K), 0.0, 2.0);
      apart_per_third_K[static_cast<std::size_t>(third)].push_back(apart_K[i]);
    }
    double margin_K = 0.3;
    for (const std::vector<double>& third_apart_K : apart_per_third_K) {
      if (third_apart_K.size() < kFewestInAThird) {
        return {};
      }
      constexpr double kErrors = 4.0;
      margin_K = std::max(margin_K, kErrors * 1.25 * std::hypot(quality(*winding_).noise, quality(*stator_).noise) /
                                        std::sqrt(static_cast<double>(third_apart_K.size())));
    }
    const double hot_K = middle_of(apart_per_third_K[0]);
    const double warm_K = middle_of(apart_per_third_K[1]);
    const double cool_K = middle_of(apart_per_third_K[2]);
    // If iron was heated and the winding only lagged, the winding ends slightly hotter.
    const bool stays_above = cool_K < kStatorAbove_K || cool_K - hot_K > kMoreThanLag_K;
    if (hot_K < -kStatorAbove_K && stays_above && warm_K - hot_K > margin_K && cool_K - warm_K > margin_K) {
      return {-1, -hot_K};
    }
    return {hot_K - cool_K > margin_K ? 1 : 0, 0.0};
  }

  const Recording& recording_;
  std::span<const ChannelQuality> channels_;
  const Channel* winding_;
  const Channel* stator_;
  const Channel* ambient_;
  const Channel* speed_;
  double block_s_ = 0.0;
  std::vector<char> rests_;  ///< per row: 1 if nothing heats the motor
  std::vector<Suspicion> found_;
};

}  // namespace

std::vector<Suspicion> suspicious_places(const Recording& recording, std::span<const ChannelQuality> channels) {
  return recording.rows() < 2 ? std::vector<Suspicion>{} : Places(recording, channels).run();
}

}  // namespace heatsoak::recording
