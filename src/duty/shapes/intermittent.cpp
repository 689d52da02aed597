#include <algorithm>
#include <cmath>

#include "duty/duty.h"

namespace heatsoak::duty::shapes {
namespace {

/// Returns the spread of a parameter as the spread of a factor around 1.
base::ParameterValue as_factor(const base::ParameterValue& parameter) {
  base::ParameterValue factor = parameter;
  factor.value = 1.0;
  if (factor.spread && parameter.value != 0.0) {
    factor.spread->low /= parameter.value;
    factor.spread->high /= parameter.value;
    factor.spread->by_ratio = factor.spread->low > 0.0;
  }
  return factor;
}

class Intermittent final : public DutyShape {
 public:
  Intermittent(const LoadBin& on, double off_s, int repeats, const LoadPoint& point)
      : on_(on), off_s_(off_s), repeats_(repeats), point_(point) {}

  [[nodiscard]] std::vector<WheelDemand> demand(const robot::Robot& /*robot*/, std::uint64_t /*seed*/) const override {
    WheelDemand wheel{.wheel = "any wheel", .bins = {}, .points = {point_}};
    for (int i = 0; i < repeats_; ++i) {
      wheel.bins.push_back(on_);
      if (off_s_ > 0.0) {
        wheel.bins.push_back(constant_bin(off_s_, 0.0, 0.0, 0.0));
      }
    }
    return {wheel};
  }

 private:
  LoadBin on_;
  double off_s_;
  int repeats_;
  LoadPoint point_;
};

void read_intermittent(input::Reader& table, const std::filesystem::path& /*folder*/, Duty& duty) {
  constexpr double kLongest_s = 1e6;
  const base::ParameterSpec torque{"torque_on", "N m", base::Range::positive(), "torque at one wheel while the load is on"};
  const base::ParameterSpec current{"current_on", "A", base::Range::positive(), "current through the motor while the load is on"};
  const std::optional<base::ParameterValue> torque_on = table.parameter(torque, input::Need::optional);
  const std::optional<base::ParameterValue> current_on = table.parameter(current, input::Need::optional);
  const base::ParameterSpec speed{"speed_on", "rad/s", base::Range::non_negative(), "speed of the wheel while the load is on"};
  const base::ParameterSpec time_on{"time_on", "s", base::Range::positive(), "time with load in one cycle"};
  const base::ParameterSpec time_off{"time_off", "s", base::Range::non_negative(), "time without load in one cycle"};
  const base::ParameterSpec cycles{"repeats", "", base::Range::between(1.0, 1e6), "number of cycles"};
  const std::optional<double> speed_on = table.quantity(speed, input::Need::required);
  const std::optional<double> on_s = table.quantity(time_on, input::Need::required);
  const std::optional<double> off_s = table.quantity(time_off, input::Need::required);
  const std::optional<double> repeats = table.quantity(cycles, input::Need::required);
  const std::vector<std::string> keys = table.keys();
  const auto gives = [&](std::string_view key) { return std::ranges::find(keys, key) != keys.end(); };
  if (gives("torque_on") == gives("current_on")) {
    table.problem("torque_on", "expected exactly one of torque_on and current_on");
    return;
  }
  if ((!torque_on && !current_on) || !speed_on || !on_s || !off_s || !repeats) {
    return;
  }
  if (*repeats != std::floor(*repeats)) {
    table.problem("repeats", "is not a whole number");
    return;
  }
  if ((*on_s + *off_s) * *repeats > kLongest_s) {
    table.problem("repeats", "makes the duty longer than 1 000 000 s; expected about the length of a match");
    return;
  }
  duty.kind = torque_on ? DutyKind::torque : DutyKind::current;
  duty.load = as_factor(torque_on ? *torque_on : *current_on);
  duty.parameters.emplace_back(torque_on ? torque : current, torque_on ? *torque_on : *current_on);
  for (const auto& [spec, value] : {std::pair(speed, *speed_on), {time_on, *on_s}, {time_off, *off_s}, {cycles, *repeats}}) {
    duty.parameters.emplace_back(spec, base::ParameterValue{}).second.value = value;
  }
  const double torque_Nm = torque_on ? torque_on->value : 0.0;
  const double current_A = current_on ? current_on->value : 0.0;
  duty.shape_data = std::make_shared<Intermittent>(constant_bin(*on_s, torque_Nm, *speed_on, current_A), *off_s, static_cast<int>(*repeats),
                                                   LoadPoint{torque_Nm, *speed_on, current_A, *on_s * *repeats});
}

}  // namespace

ShapeType intermittent() {
  return {.name = {},
          .summary = "alternately on and off: a torque (or a current) and a speed for time_on, standstill without current for time_off",
          .example = R"(shape = "intermittent"
[intermittent]
torque_on = { value = "120 mN m", origin = "estimated", derivation = "why this value" }
speed_on = "40 rad/s"
time_on = "4 s"
time_off = "6 s"
repeats = "240"
)",
          .read = read_intermittent};
}

}  // namespace heatsoak::duty::shapes
