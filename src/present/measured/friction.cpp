#include "present/measured/friction.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/quantity.h"
#include "present/measured/friction_words.h"
#include "present/robot_notes.h"

namespace heatsoak::present {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

/// Formats a value with its interval; `without_interval` explains why there is none.
std::string estimate_text(const std::optional<friction::Estimate>& estimate, int decimals, double scale = 1.0,
                          const std::string& without_interval = "given") {
  if (!estimate) {
    return "–";
  }
  const auto& interval = estimate->interval;
  return interval ? fmt::format("{:.{}f} [{:.{}f}…{:.{}f}]", scale * estimate->value, decimals, scale * interval->low, decimals,
                                scale * interval->high, decimals)
                  : fmt::format("{:.{}f} ({})", scale * estimate->value, decimals, without_interval);
}

std::string plural_of(std::size_t count, std::string_view what) { return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s"); }

Table wheel_table(const friction::FrictionFit& fit, std::size_t rows) {
  Table table{.title = "Voltage of a wheel: d ω + a sin(θ + phase) + b sign",
              .columns = {{"wheel", "", 0},
                          {"d", "V s/rad", 0},
                          {"a", "V", 0},
                          {"b", "V", 1},
                          {"phase", "°", 2},
                          {"R²", "", 3},
                          {"rows", "", 4},
                          {"left out", "", 5}},
              .rows = {}};
  for (std::size_t i = 0; i < fit.wheels.size(); ++i) {
    const friction::WheelFriction& wheel = fit.wheels[i];
    if (!wheel.is_learned()) {
      table.rows.push_back({{fmt::format("{}", i + 1)}, {"not identifiable", Tone::bad}, {"–"}, {"–"}, {"–"}, {"–"}, {"–"}, {"–"}});
      continue;
    }
    table.rows.push_back({{fmt::format("{}", i + 1)},
                          {estimate_text(wheel.damping_V_s_per_rad, 4)},
                          {estimate_text(wheel.sine_V, 3)},
                          {estimate_text(wheel.constant_V, 3)},
                          {estimate_text(wheel.phase_rad, 1, kDegrees)},
                          {wheel.r2_ratio ? fmt::format("{:.3f}", *wheel.r2_ratio) : "–"},
                          {fmt::format("{}", wheel.rows_used)},
                          {fmt::format("{}", rows - wheel.rows_used)}});
  }
  return table;
}

/// Adds notes about values that the legs do not determine.
void add_given_values(Document& document, const friction::FrictionFit& fit) {
  if (std::ranges::any_of(fit.wheels, &friction::WheelFriction::damping_is_given)) {
    std::vector<std::string> moves;
    for (std::size_t i = 0; i < fit.wheels.size(); ++i) {
      if (fit.wheels[i].damping_is_given) {
        moves.push_back(fmt::format("{} V (wheel {})", base::significant(0.1 * std::abs(fit.wheels[i].sine_per_damping_V), 2), i + 1));
      }
    }
    document.add_note(
        Severity::note,
        fmt::format(
            "The intervals hold only for the given d, the motor's back-EMF from its file. A d 10 % larger makes a smaller by {}. Legs "
            "at a second speed on the same headings determine both.",
            fmt::join(moves, ", ")));
  }
  if (std::ranges::any_of(fit.wheels, &friction::WheelFriction::phase_is_given)) {
    document.add_note(
        Severity::note,
        fmt::format(
            "The given phase is the wheel's rolling direction; the intervals allow for {:.0f}° to either side. The headings are too "
            "few to determine it. Six or more directions all around determine it.",
            friction::FitSettings{}.phase_uncertainty_rad * kDegrees));
  }
}

void add_wheel_notes(Document& document, const friction::FrictionFit& fit) {
  for (std::size_t i = 0; i < fit.wheels.size(); ++i) {
    const friction::WheelFriction& wheel = fit.wheels[i];
    if (!wheel.is_learned()) {
      document.add_note(Severity::warning, fmt::format("Wheel {} is not identifiable: {}.", i + 1, words_of(*wheel.problem)));
    }
    if (wheel.phase_is_bounded) {
      document.add_note(Severity::note, fmt::format("Wheel {}: the phase is limited by the measured sense of rotation; the friction hardly "
                                                    "follows a sin(θ+φ) + b sign.",
                                                    i + 1));
    }
    if (wheel.rotation_V) {
      document.add_note(Severity::background,
                        fmt::format("Wheel {} turning on the spot: {} V.", i + 1, estimate_text(wheel.rotation_V, 3)));
    }
  }
  if (std::ranges::any_of(fit.wheels, [](const friction::WheelFriction& wheel) {
        return wheel.rotation_V && wheel.rotation_V->interval && wheel.rotation_V->interval->high < 0.0;
      })) {
    document.add_note(Severity::warning,
                      "A friction below 0 V is impossible: the voltage is not proportional to the modulation, or the assumed battery "
                      "voltage is wrong.");
  }
}

std::string what_rolls(const friction::RollOutRun& run) {
  return run.kind == friction::RollOut::translation ? fmt::format("towards {:.0f}°, {:.2f} N", run.heading_rad * kDegrees, run.force_N)
         : run.kind == friction::RollOut::rotation  ? "turning"
                                                    : fmt::format("wheel {} lifted", run.wheel.value() + 1);
}

/// Returns one sentence for each wheel whose measurements contradict the assumed friction law.
std::vector<std::string> lack_of_fit_words(const friction::FrictionFit& fit) {
  std::vector<std::string> found;
  for (std::size_t i = 0; i < fit.wheels.size(); ++i) {
    if (const friction::LackOfFit& lack = fit.wheels[i].lack; lack.is_found) {
      found.push_back(fmt::format(
          "the residual of wheel {} depends on θ: {} V rms beyond the {} V by which {} differ. The law a sin(θ+φ) + b sign "
          "does not hold there; the intervals of a and b are wider to allow for this error",
          i + 1, base::significant(lack.left_V.value(), 2), base::significant(lack.repeats_V.value(), 2), words_of(lack.repeats)));
    }
  }
  return found;
}

Document document_of(const friction::FrictionJob& job, const friction::SteadyFriction& answer) {
  Document document{
      .headline = {{fmt::format("{}: the friction of {} is identifiable.", job.robot.id, identifiable_wheels(answer.fit)),
                    std::ranges::all_of(answer.fit.wheels, &friction::WheelFriction::is_learned) ? Tone::good : Tone::undecided}},
      .paragraphs = {fmt::format(
          "{}, {} rows, {} of them steady in {} on {}; {} {}.", plural_of(job.logs.size(), "log"), answer.steady.rows,
          answer.steady.rows_steady, plural_of(static_cast<std::size_t>(answer.steady.legs), "leg"),
          plural_of(static_cast<std::size_t>(answer.fit.headings), "heading"),
          plural_of(static_cast<std::size_t>(answer.steady.return_legs), "return leg"), job.use_return_legs ? "used too" : "left out")},
      .tables = {wheel_table(answer.fit, answer.steady.rows)}};
  if (answer.error.after_V) {
    document.paragraphs.push_back(fmt::format(
        "Hold-out error on {} of {} headings: {}{:.3f} V after the fit.", answer.error.headings, answer.error.all_headings,
        answer.expected_from ? fmt::format("{:.3f} V by {}, ", answer.error.before_V.value(), words_of(*answer.expected_from)) : "",
        *answer.error.after_V));
  }
  for (const std::string& each : lack_of_fit_words(answer.fit)) {
    document.add_note(Severity::warning, each);
  }
  add_given_values(document, answer.fit);
  add_wheel_notes(document, answer.fit);
  return document;
}

Document document_of(const friction::FrictionJob& job, const friction::RollOutFriction& answer) {
  const friction::RollOutResult& result = answer.result;
  Document document{.headline = {{fmt::format("{}: {} in {}, motors assumed open.", job.robot.id, plural_of(result.runs.size(), "roll-out"),
                                              plural_of(job.logs.size(), "log"))}},
                    .paragraphs = {"Torque and damping of a wheel without the motor's back-EMF; d with it."}};
  const auto fitted = [](const std::optional<friction::Estimate>& estimate, int decimals, double scale) {
    return estimate_text(estimate, decimals, scale, "no interval");
  };
  Table wheels{.columns = {{"wheel", "", 0}, {"torque", "mN m", 0}, {"damping", "mN m s/rad", 1}, {"d", "V s/rad", 0}}, .rows = {}};
  for (std::size_t i = 0; i < result.wheel_damping_Nm_s_per_rad.size(); ++i) {
    const std::optional<friction::Estimate>& mechanical = result.wheel_damping_Nm_s_per_rad[i];
    wheels.rows.push_back({{fmt::format("{}", i + 1)},
                           {fitted(result.wheel_torque_Nm[i], 2, 1e3)},
                           {fitted(mechanical, 4, 1e3)},
                           {fitted(damping_with_back_emf(answer.drive, mechanical), 4, 1.0)}});
  }
  Table runs{
      .title = "Roll-outs, values per wheel",
      .columns = {{"run", "", 0, Alignment::left}, {"torque", "mN m", 0}, {"damping", "mN m s/rad", 0}, {"R²", "", 1}, {"rows", "", 2}},
      .rows = {}};
  for (const friction::RollOutRun& run : result.runs) {
    runs.rows.push_back({{what_rolls(run)},
                         {fmt::format("{:.1f}", 1e3 * run.wheel_torque_Nm)},
                         {fmt::format("{:.3f}", 1e3 * run.wheel_damping_Nm_s_per_rad)},
                         {fmt::format("{:.3f}", run.r2_ratio)},
                         {fmt::format("{}", run.rows_used)}});
  }
  document.tables = {std::move(wheels), std::move(runs)};
  return document;
}

FrictionRemarks remarks_of(const friction::FrictionJob& job, const friction::FrictionRun& run, const std::vector<std::string>& of_fit) {
  FrictionRemarks remarks{.findings = {}, .suspicions = words_of(run.suspicions)};
  if (!job.motor) {
    remarks.findings.push_back(fmt::format("there is no file of the robot's motor '{}'; name a motor with --motor", job.motor_id));
  }
  for (const friction::FrictionFinding& each : run.findings) {
    remarks.findings.push_back(words_of(each));
  }
  remarks.findings.insert(remarks.findings.end(), of_fit.begin(), of_fit.end());
  return remarks;
}

std::vector<std::string> words_of_fit(const friction::SteadyFriction& found) { return lack_of_fit_words(found.fit); }
std::vector<std::string> words_of_fit(const friction::RollOutFriction& /*found*/) { return {}; }

/// Adds the findings as notes and the suspicions as warnings.
void add_remarks(Document& document, const FrictionRemarks& remarks) {
  for (const std::string& suspicion : remarks.suspicions) {
    document.add_note(Severity::warning, fmt::format("suspicious: {}", suspicion));
  }
  for (const std::string& finding : remarks.findings) {
    document.add_note(Severity::note, finding);
  }
}

}  // namespace

std::string identifiable_wheels(const friction::FrictionFit& fit) {
  return fmt::format("{} of {} wheels", std::ranges::count_if(fit.wheels, &friction::WheelFriction::is_learned), fit.wheels.size());
}

std::optional<friction::Estimate> damping_with_back_emf(const robot::DriveConstants& drive,
                                                        const std::optional<friction::Estimate>& mechanical_Nm_s_per_rad) {
  if (!mechanical_Nm_s_per_rad) {
    return std::nullopt;
  }
  const auto volts = [&](double damping) { return robot::steady_voltage_V(drive, damping, 1.0); };
  friction::Estimate found{.value = volts(mechanical_Nm_s_per_rad->value)};
  if (const auto& interval = mechanical_Nm_s_per_rad->interval) {
    found.interval = {volts(interval->low), volts(interval->high)};
  }
  return found;
}

Document friction_document(const friction::FrictionJob& job, const friction::FrictionAnswer& answer) {
  return std::visit(
      [&](const auto& found) {
        Document document = document_of(job, found);
        const FrictionRemarks remarks = remarks_of(job, found, words_of_fit(found));
        add_remarks(document, remarks);
        add_robot_notes(document, job.robot);
        for (const friction::WrittenAsZero& each : found.notes) {
          document.add_note(Severity::note, words_of(each));
        }
        document.data = friction_json(job, found, remarks);
        return document;
      },
      answer);
}

}  // namespace heatsoak::present
