#include "check/computations.h"
#include "select/decision.h"

namespace heatsoak::check::thresholds {
namespace {

Measured measure_rank(const Check& check, Computations& computations) {
  const select::MotorEvaluation& own = computations.feasible_evaluation(check);
  std::vector<std::string> better;
  for (const motor::Motor& motor : check.against) {
    const select::MotorEvaluation& other = computations.evaluation(check, motor);
    if (select::ranks_before(other, own)) {
      better.push_back(other.motor_id);
    }
  }
  return {static_cast<double>(better.size() + 1), 0.0, RankBasis{check.against.size() + 1, better}};
}

}  // namespace

ThresholdType rank() {
  return {.name = {},
          .unit = "",
          .is_whole = true,
          .range = base::Range::between(1.0, 1e4),
          .room = Room::none,
          .meaning =
              "rank of the motor among itself and those of 'against', in the order of `evaluate`: verdict, then the margin to the "
              "nearer limit, on a match that of the 95th percentile. \"at most 1\": it stays first",
          .example = "at most 1",
          .needs = {Setting::robot, Setting::duty, Setting::motor, Setting::against},
          .takes = {Setting::samples, Setting::seed, Setting::conditions},
          .loosest = [](const Check& check) -> std::optional<LoosestLimit> {
            // A limit at the last rank always holds. If `against` is empty, other problems are reported.
            return check.against.empty()
                       ? std::nullopt
                       : std::optional<LoosestLimit>({static_cast<double>(check.against.size()), LoosestBy::motors_against});
          },
          .measure = measure_rank};
}

}  // namespace heatsoak::check::thresholds
