// The guard in integers, for controllers without a floating-point unit.
#include <embedded/integer_table_text.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "derate/c_header/c_text.h"
#include "derate/export_text.h"
#include "derate/exporter.h"
#include "derate/integer_form/integer_lines.h"
#include "derate/integer_form/integer_memory.h"
#include "derate/integer_form/quantised_table.h"
#include "derate/plausible_range.h"
#include "derate/power_off.h"

namespace heatsoak::derate::exporters {
namespace {

using integer_form::FixedPoint;
using integer_form::IntegerLines;
using integer_form::QuantisedTable;

constexpr int kStoredBits = 32;             ///< fraction bits of a stored temperature
constexpr std::int32_t kReadHotter_mC = 3;  ///< added to temperatures before the table lookup; larger than all rounding errors

struct InputField {
  observed::Signal signal;
  std::string_view name;
  std::string_view meaning;
  std::string_view flag;  ///< variable that is true if the reading was replaced
};
constexpr InputField kInputs[] = {
    {observed::current, "current_mA", "equivalent DC current, rms over the period, with the sign of the speed when the motor drives",
     "is_current_unknown"},
    {observed::speed, "speed_mrad_per_s", "speed of the motor's shaft, signed", "is_speed_unknown"},
    {observed::ambient, "ambient_mC", "air around the motor in 0.001 degC; the hottest declared air if it is not measured",
     "is_ambient_unknown"}};

std::int64_t thousandths_outward(double value) {
  return static_cast<std::int64_t>(value < 0.0 ? std::floor(1000.0 * value) : std::ceil(1000.0 * value));
}

/// Accepted integers, all within the plausible range.
struct AcceptedRange {
  explicit AcceptedRange(const PlausibleRange& range)
      : least(static_cast<std::int64_t>(std::ceil(1000.0 * range.low))), most(static_cast<std::int64_t>(std::floor(1000.0 * range.high))) {}
  std::int64_t least;
  std::int64_t most;
};

std::string integers(std::string_view type, const std::string& name, const std::vector<std::int64_t>& values) {
  std::string text = fmt::format("static const {} {}[{}] = {{", type, name, values.size());
  constexpr std::size_t kInLine = 12;
  for (std::size_t i = 0; i < values.size(); ++i) {
    text += fmt::format("{}{}{}", i % kInLine == 0 ? "\n    " : " ", values[i], i + 1 < values.size() ? "," : "");
  }
  return text + "};\n";
}

template <class Number>
std::vector<std::int64_t> widened(const std::vector<Number>& values) {
  return {values.begin(), values.end()};
}

/// Returns the heat that is added to a node's rate, in units of that rate, so that rounding never makes the node cooler.
std::int64_t heat_for_rounding(const FixedPoint& rate) {
  const double most = std::max(std::abs(rate.low), std::abs(rate.high));
  return static_cast<std::int64_t>(std::ceil(std::ldexp(rate.most_error + std::ldexp(most, -29), rate.bits))) + 1;
}

/// Returns how far, in K, the temperatures may lie above the exact ones because of the heat added for rounding, over a warm-up of 4 h.
double temperature_excess_K(const Derating& derating, const IntegerLines& lines) {
  const Observer& observer = derating.observer;
  thermal::FormulaRun<double> run(observer.formula(), observer.rate_steps());
  const std::size_t nodes = observer.state_count();
  std::vector<double> inputs(observed::kSignalCount + nodes, derating.rules.hottest_ambient_C);
  inputs[observed::current] = limp_current_A(derating);
  inputs[observed::speed] = 0.0;
  std::vector<double> rate(nodes);
  std::vector<std::vector<double>> state_C(2, std::vector<double>(nodes, derating.rules.hottest_ambient_C));
  constexpr double kDuration_s = 4.0 * 3600.0;
  const double step_s = 4.0 * derating.options.period_s;
  double most_K = 0.0;
  for (double time_s = 0.0; time_s < kDuration_s; time_s += step_s) {
    for (std::size_t form = 0; form < 2; ++form) {
      std::ranges::copy(state_C[form], inputs.begin() + observed::kSignalCount);
      run.run(inputs, rate);
      for (std::size_t node = 0; node < nodes; ++node) {
        const FixedPoint& fixed = lines.rate_K_per_s[node];
        const double extra = form == 0 ? 0.0 : std::ldexp(static_cast<double>(heat_for_rounding(fixed)), -fixed.bits) + fixed.most_error;
        state_C[form][node] += step_s * (rate[node] + extra);
      }
    }
    for (std::size_t node = 0; node < nodes; ++node) {
      most_K = std::max(most_K, state_C[1][node] - state_C[0][node]);
    }
  }
  return most_K;
}

constexpr std::string_view kHelpers = R"(/* a * b / divisor, a power of two that selects the unit of the result's last bit */
static inline int32_t @_product(int32_t a, int32_t b, int64_t divisor) {
  const int64_t whole = (int64_t)a * b;
  return (int32_t)(whole / divisor);
}

)";

constexpr std::string_view kQuotient = R"(/* a * factor / b, factor a power of two */
static inline int32_t @_quotient(int32_t a, int32_t b, int64_t factor) {
  const int64_t whole = a * factor;
  return (int32_t)(whole / b);
}

)";

constexpr std::string_view kStart = R"(static inline bool @_is_temperature(int64_t stored) {
  return (stored >= (((int64_t)@CAP@_COLDEST_AMBIENT_MC - 1000) * @CAP@_STORED_PER_K / 1000)) && (stored <= (@MOST_STATE@ * @CAP@_STORED_PER_K));
}

/* body_mC: temperature of the whole motor after a rest in 0.001 degC; an implausible value counts as the limit. */
static inline void @_start(@_state *state, int32_t body_mC) {
  const int64_t asked = (int64_t)body_mC * @CAP@_STORED_PER_K / 1000;
  int32_t node;
  for (node = 0; node < @NODES@; ++node) {
    state->stored[node] = @_is_temperature(asked) ? asked : ((int64_t)@CAP@_WINDING_LIMIT_MC * @CAP@_STORED_PER_K / 1000);
  }
  state->started = @CAP@_STARTED;
}

)";

constexpr std::string_view kSweep =
    R"(/* Each node takes its largest temperature rise over the possible values; the input takes the value that heats the winding most. */
static inline void @_sweep(const @_input *input, int32_t *which, const int32_t *possible, int32_t count, const int32_t *state_C, int64_t *most) {
  int64_t change[@NODES@];
  int64_t hottest_change = 0;
  int32_t hottest = possible[0];
  int32_t i;
  int32_t node;
  for (i = 0; i < count; ++i) {
    *which = possible[i];
    @_changes(input, state_C, change);
    for (node = 0; node < @NODES@; ++node) {
      most[node] = (change[node] > most[node]) ? change[node] : most[node];
    }
    if ((i == 0) || (change[0] > hottest_change)) {
      hottest_change = change[0];
      hottest = possible[i];
    }
  }
  *which = hottest;
}

)";

constexpr std::string_view kStep = R"(static inline @_output @_step(@_state *state, const @_input *measured) {
  const int64_t coldest = (int64_t)@CAP@_COLDEST_AMBIENT_MC * @CAP@_STORED_PER_K / 1000;
  const int64_t hottest = @MOST_STATE@ * @CAP@_STORED_PER_K;
  @_output out;
  @_input in = *measured;
  int64_t change[@NODES@];
  int32_t state_C[@NODES@];
  int32_t hottest_body_mC;
  int32_t node;
@PASS@  bool is_started = state->started == @CAP@_STARTED;
  bool is_current_unknown = false;
  bool is_speed_unknown = false;
  bool is_ambient_unknown = false;
  for (node = 0; node < @NODES@; ++node) {
    is_started = is_started && @_is_temperature(state->stored[node]);
  }
  if (!is_started) {
    @_start(state, @CAP@_WINDING_LIMIT_MC);
  }
@PLAUSIBLE@  for (node = 0; node < @NODES@; ++node) {
    state_C[node] = (int32_t)(state->stored[node] / @CAP@_STORED_PER_STATE);
  }
  @_changes(&in, state_C, change);
@SWEEPS@  for (node = 0; node < @NODES@; ++node) {
    const int64_t next = state->stored[node] + change[node];
    state->stored[node] = (next > coldest) ? next : coldest;
    state->stored[node] = (state->stored[node] < hottest) ? state->stored[node] : hottest;
  }
  out.guarded_winding_mC = (int32_t)((state->stored[0] * 1000) / @CAP@_STORED_PER_K) + @CAP@_READ_HOTTER_MC;
  hottest_body_mC = (int32_t)((state->stored[1] * 1000) / @CAP@_STORED_PER_K) + @CAP@_READ_HOTTER_MC;
@BODIES@  out.allowed_current_mA =
      is_speed_unknown ? 0
                       : heatsoak_integer_allowed_mA(&@_table, (in.speed_mrad_per_s < 0) ? -in.speed_mrad_per_s : in.speed_mrad_per_s,
                                                     hottest_body_mC, out.guarded_winding_mC);
  if (!is_started) {
    out.reason = @_not_started;
  } else if (is_current_unknown || is_speed_unknown || is_ambient_unknown) {
    out.reason = @_input_unknown;
  } else if ((out.allowed_current_mA >= @_table.most_current_mA) ||
             ((out.allowed_current_mA > 0) && (hottest_body_mC <= @_stator_mC[0]) && (out.guarded_winding_mC <= @_winding_mC[0]))) {
    out.reason = @_full;
  } else {
    out.reason = (out.allowed_current_mA > 0) ? @_derated : @_no_current;
  }
  return out;
}
)";

constexpr std::string_view kBodies = R"(  for (node = 2; node < @NODES@; ++node) {
    const int32_t body_mC = (int32_t)((state->stored[node] * 1000) / @CAP@_STORED_PER_K) + @CAP@_READ_HOTTER_MC;
    hottest_body_mC = (body_mC > hottest_body_mC) ? body_mC : hottest_body_mC;
  }
)";

/// The same for the only node beyond winding and stator.
constexpr std::string_view kThirdBody = R"(  node = (state->stored[2] > state->stored[1]) ? 2 : 1;
  hottest_body_mC = (int32_t)((state->stored[node] * 1000) / @CAP@_STORED_PER_K) + @CAP@_READ_HOTTER_MC;
)";

/// Formats text as comment lines; "*/" in a user's text cannot end the comment.
std::string comment_lines(std::string text) {
  for (std::size_t at = text.find("*/"); at != std::string::npos; at = text.find("*/")) {
    text.replace(at, 2, "* /");
  }
  return text;
}

std::string head(const Derating& derating, const std::string& prefix, const IntegerLines& lines, const QuantisedTable& table) {
  const double table_ratio = integer_form::quantised_shortfall_ratio(derating.table, table);
  std::string text = "/*\n" + comment_lines(provenance_lines(derating, " *"));
  text += " *\n" + law_lines(derating, " *");
  text += fmt::format(
      " *\n"
      " * Thermal observer and derating table in integers. For nominal temperatures and other signals use c_header.\n"
      " * While no reading is replaced and before the first restore, temperatures are 0 to {0:.2g} K above those of the header in single\n"
      " * precision, else further above. At equal temperatures the current is never above that of its table and at most {1:.1f} % below "
      "it, for currents of {2:.3g} A and more.\n"
      " * Once, after a long rest: {3}_start(&motor, board_mC);\n"
      " *   a state that was never started counts as hot as its limit.\n"
      " * After a loss of power instead: {3}_restore(&motor, saved, elapsed_ms, unsaved_ms, board_mC); {3}_save fills `saved`.\n"
      " * Every {4:.9g} s: out = {3}_step(&motor, &in);\n"
      " *   then |current| <= out.allowed_current_mA until the next call.\n"
      " */\n",
      temperature_excess_K(derating, lines) + 1e-3 * kReadHotter_mC, 100.0 * table_ratio, derating.table.straight_below_A, prefix,
      derating.options.period_s);
  return text;
}

std::string structures(const Derating& derating, const std::string& prefix) {
  std::string text = "typedef struct {\n";
  for (const InputField& field : kInputs) {
    text += fmt::format("  int32_t {}; /* {} */\n", field.name, field.meaning);
  }
  return text + fmt::format(
                    "}} {0}_input;\n"
                    "\n"
                    "typedef struct {{\n"
                    "  uint32_t started;\n"
                    "  int64_t stored[{1}]; /* 2^-{3} K:{4}; safety factor on heat {2:.3g} */\n"
                    "}} {0}_state;\n"
                    "\n"
                    "typedef enum {{\n"
                    "  {0}_full, /* all that a cold motor may draw at this speed */\n"
                    "  {0}_derated, /* less, because the winding or the stator is hot */\n"
                    "  {0}_no_current,\n"
                    "  {0}_input_unknown,\n"
                    "  {0}_not_started\n"
                    "}} {0}_reason;\n"
                    "\n"
                    "typedef struct {{\n"
                    "  int32_t allowed_current_mA; /* equivalent DC current, magnitude, until the next step */\n"
                    "  int32_t guarded_winding_mC; /* 0.001 degC, pessimistic; sets the allowed current */\n"
                    "  {0}_reason reason;\n"
                    "}} {0}_output;\n"
                    "\n",
                    prefix, derating.observer.state_count(), derating.observer.heat_safety_factor(), kStoredBits, [&] {
                      std::string names;
                      for (const std::string& name : derating.observer.state_names()) {
                        names += fmt::format(" {}", c_header::in_comment(name));
                      }
                      return names;
                    }());
}

std::string table_text(const QuantisedTable& table, const std::string& prefix) {
  return integers("int32_t", prefix + "_speed_mrad_per_s", widened(table.speed_mrad_per_s)) +
         integers("int32_t", prefix + "_stator_mC", widened(table.stator_mC)) +
         integers("int32_t", prefix + "_winding_mC", widened(table.winding_mC)) +
         fmt::format("/* I^2 * R / R25 in units of {} mA^2: by speed, then stator, then winding */\n", table.unit_mA2) +
         integers("int16_t", prefix + "_heat_per_ohm", widened(table.heat)) +
         fmt::format(
             "static const heatsoak_integer_table {0}_table = {{\n    {{{0}_speed_mrad_per_s, {1}}},\n    {{{0}_stator_mC, {2}}},\n"
             "    {{{0}_winding_mC, {3}}},\n    {0}_heat_per_ohm,\n    {4}u, /* unit_mA2 */\n    {5}, /* resistance_at_first, {12:.6g} */\n"
             "    {6}, /* resistance_per_mK, {13:.6g} per K */\n    {7}, /* most_current_mA */\n    {8}, /* straight_below_mA */\n"
             "    {9}, /* most_speed_mrad_per_s */\n    {10}, /* no_current_speed_mrad_per_s */\n    {11} /* winding_per_stator_K "
             "*/}};\n\n",
             prefix, table.speed_mrad_per_s.size(), table.stator_mC.size(), table.winding_mC.size(), table.unit_mA2,
             table.resistance_at_first, table.resistance_per_mK, table.most_current_mA, table.straight_below_mA,
             table.most_speed_mrad_per_s, table.no_current_speed_mrad_per_s, table.winding_per_stator_K,
             std::ldexp(static_cast<double>(table.resistance_at_first), -20),
             1000.0 * std::ldexp(static_cast<double>(table.resistance_per_mK), -40));
}

/// Generates the function that computes each node's change over a period, in 2^-kStoredBits K, with the heat added for rounding.
std::string changes_function(const Derating& derating, const std::string& prefix, const IntegerLines& lines) {
  const double period_s = derating.options.period_s;
  const int period_bits = 29 - static_cast<int>(std::floor(std::log2(period_s)));
  const auto period = static_cast<std::int64_t>(std::ceil(std::ldexp(period_s, period_bits)));
  std::string text = fmt::format(
      "/* Temperature rise of every node in one period, rounded up. A comment behind a line is the value of its last bit; \"@_product\" "
      "and\n"
      "   \"@_quotient\" multiply and divide, and its last argument moves the binary point. */\n"
      "static inline void {0}_changes(const {0}_input *input, const int32_t *state_C, int64_t *change) {{\n{1}",
      prefix, lines.text);
  for (std::size_t node = 0; node < lines.rates.size(); ++node) {
    const FixedPoint& rate = lines.rate_K_per_s[node];
    text += fmt::format(
        "  /* {0}: {1} bounds the rounding error of the rate, {2} is the period of {3:.9g} s in 2^-{4} s; the result is in 2^-{5} K */\n"
        "  change[{6}] = ((((int64_t){7} + {1}) * {2}) / INT64_C({8})) + 1;\n",
        c_header::in_comment(derating.observer.state_names()[node]), heat_for_rounding(rate), period, period_s, period_bits, kStoredBits,
        node, lines.rates[node], std::int64_t{1} << (rate.bits + period_bits - kStoredBits));
  }
  return text + "}\n\n";
}

std::vector<std::int64_t> candidates(const Derating& derating, observed::Signal signal) {
  const PlausibleRange range = plausible_range(derating, signal);
  const AcceptedRange accepted(range);
  std::vector<std::int64_t> values;
  for (const float value : range.values) {
    values.push_back(std::clamp(thousandths_outward(value), accepted.least, accepted.most));
  }
  return values;
}

/// Name of the constant of an input: PREFIX_MOST_PLAUSIBLE_CURRENT_MA.
std::string constant_of(const std::string& capital, std::string_view what, const InputField& field) {
  return fmt::format("{}_{}_{}", capital, what, c_header::in_capitals(std::string(field.name)));
}

std::string plausible_constants(const Derating& derating, const std::string& capital) {
  std::string text =
      "/* A reading outside of its plausible range is replaced by the UNKNOWN value: the hottest that motor, driver and battery permit. "
      "*/\n";
  for (const InputField& field : kInputs) {
    const AcceptedRange accepted(plausible_range(derating, field.signal));
    text += fmt::format("#define {} {}\n#define {} {}\n#define {} {}\n", constant_of(capital, "LEAST_PLAUSIBLE", field),
                        accepted.least < 0 ? fmt::format("({})", accepted.least) : fmt::format("{}", accepted.least),
                        constant_of(capital, "MOST_PLAUSIBLE", field), accepted.most, constant_of(capital, "UNKNOWN", field),
                        candidates(derating, field.signal).front());
  }
  return text + "\n";
}

std::string plausible_ranges(const std::string& capital) {
  std::string text;
  for (const InputField& field : kInputs) {
    text += fmt::format("  if ((in.{0} < {1}) || (in.{0} > {2})) {{\n    in.{0} = {3};\n    {4} = true;\n  }}\n", field.name,
                        constant_of(capital, "LEAST_PLAUSIBLE", field), constant_of(capital, "MOST_PLAUSIBLE", field),
                        constant_of(capital, "UNKNOWN", field), field.flag);
  }
  return text;
}

/// Inputs with several possible values; one with a single value needs no sweep.
std::vector<InputField> swept_inputs(const Derating& derating) {
  std::vector<InputField> swept;
  for (const InputField& field : kInputs) {
    if (field.signal != observed::ambient && candidates(derating, field.signal).size() > 1) {
      swept.push_back(field);
    }
  }
  return swept;
}

/// Generates the sweeps over possible values. Several inputs need two passes, because the hottest value of one may depend on another.
std::string sweeps(const Derating& derating, const std::vector<InputField>& swept) {
  const std::string indent = swept.size() > 1 ? "    " : "  ";
  std::string text = swept.size() > 1 ? "  for (pass = 0; pass < 2; ++pass) {\n" : "";
  for (const InputField& field : swept) {
    text += fmt::format("{0}if ({1}) {{\n{0}  @_sweep(&in, &in.{2}, @_possible_{2}, {3}, state_C, change);\n{0}}}\n", indent, field.flag,
                        field.name, candidates(derating, field.signal).size());
  }
  return text + (swept.size() > 1 ? "  }\n" : "");
}

/// Generates `on`, the inputs of the worst-case heating, and the loops over their possible values around it.
integer_form::HeatingInputs heating_inputs(const Derating& derating, const std::vector<InputField>& swept) {
  integer_form::HeatingInputs made;
  for (const InputField& field : kInputs) {
    const bool is_swept = std::ranges::find(swept, field.signal, &InputField::signal) != swept.end();
    if (is_swept) {
      made.looped.push_back({std::string(field.name), candidates(derating, field.signal).size()});
    }
    made.fields += fmt::format("{}{}", made.fields.empty() ? "" : ", ",
                               is_swept                            ? fmt::format("@_possible_{0}[each_{0}]", field.name)
                               : field.signal == observed::ambient ? std::string("@CAP@_HOTTEST_AMBIENT_MC")
                                                                   : constant_of("@CAP@", "UNKNOWN", field));
  }
  return made;
}

std::string possible_values(const Derating& derating, const std::string& prefix, const std::vector<InputField>& swept) {
  std::string text = swept.empty() ? "" : "/* possible values of an unknown input */\n";
  for (const InputField& field : swept) {
    text += integers("int32_t", fmt::format("{}_possible_{}", prefix, field.name), candidates(derating, field.signal));
  }
  return text;
}

std::vector<std::int64_t> resting_temperatures(const Derating& derating) {
  std::vector<std::int64_t> stored;
  for (const double node_C : resting_C(derating, derating.observer.rate_steps())) {
    stored.push_back(static_cast<std::int64_t>(std::ceil(std::ldexp(node_C, kStoredBits))));
  }
  return stored;
}

std::string write_c_header_q15(const Derating& derating) {
  require_finite(derating);
  require_three_signals("c_header_q15", derating);
  const std::string prefix = identifier(derating.motor_id) + "_q15";
  const std::string capital = c_header::in_capitals(prefix);
  const IntegerLines lines = integer_form::integer_lines(derating, prefix);
  const QuantisedTable table(derating.table);
  const std::vector<InputField> swept = swept_inputs(derating);
  const std::size_t nodes = derating.observer.state_count();
  const c_header::Words words{{"@PLAUSIBLE@", plausible_ranges(capital)},
                              {"@SWEEPS@", sweeps(derating, swept)},
                              {"@PASS@", swept.size() > 1 ? "  int32_t pass;\n" : ""},
                              {"@BODIES@", std::string(nodes == 3  ? kThirdBody
                                                       : nodes > 3 ? kBodies
                                                                   : "")},
                              {"@NODES@", std::to_string(nodes)},
                              {"@MOST_STATE@", std::to_string(static_cast<int>(kMostState_C))},
                              {"@CAP@", capital},
                              {"@", prefix}};
  const auto define = [&](std::string_view name, std::int64_t value) { return fmt::format("#define {}_{} {}\n", capital, name, value); };
  const auto period_us = static_cast<std::int64_t>(std::ceil(1e6 * derating.options.period_s));
  return c_header::wrapped(
      head(derating, prefix, lines, table) +
      fmt::format("#ifndef HEATSOAK_{0}_{1:08X}_H\n#define HEATSOAK_{0}_{1:08X}_H\n\n#include <stdbool.h>\n#include <stdint.h>\n\n",
                  capital, guard_signature(derating, "q15")) +
      std::string(embedded::integer_table_text().front().text) + "\n" + c_header::shared_text("crc_32.h") + "\n" +
      define("WINDING_LIMIT_MC", static_cast<std::int64_t>(std::floor(1000.0 * derating.rules.limits.winding_C))) +
      define("HOTTEST_AMBIENT_MC", candidates(derating, observed::ambient).front()) +
      define("COLDEST_AMBIENT_MC", static_cast<std::int64_t>(std::floor(1000.0 * derating.options.coldest_ambient_C))) +
      fmt::format("#define {0}_STORED_PER_K INT64_C({1})\n#define {0}_STARTED 0x48454154u\n#define {0}_PERIOD_US INT64_C({2})\n", capital,
                  std::int64_t{1} << kStoredBits, period_us) +
      fmt::format("#define {0}_STORED_PER_STATE {1} /* stored temperatures are in 2^-{2} K, those of the laws in 2^-{3} K */\n"
                  "#define {0}_ONE_THOUSANDTH {5} /* 0.001 in 2^-39 */\n"
                  "#define {0}_READ_HOTTER_MC {4} /* added to a temperature that is read, more than all rounding errors */\n",
                  capital, 1 << (kStoredBits - integer_form::kStateBits), kStoredBits, integer_form::kStateBits, kReadHotter_mC,
                  integer_form::kOneThousandth) +
      fmt::format("#define {0}_SIGNATURE 0x{1:08x}u\n#define {0}_SAVED_SIZE {2}\n#define {0}_MOST_COOLING_STEPS {3}\n"
                  "#define {0}_MOST_HEATING_STEPS {4}\n\n",
                  capital, guard_signature(derating, "q15"), 8 * (1 + nodes), kMostCoolingSteps, kMostHeatingSteps) +
      plausible_constants(derating, capital) + structures(derating, prefix) + table_text(table, prefix) +
      c_header::replaced(kHelpers, words) +
      (lines.text.find("_quotient(") == std::string::npos ? "" : c_header::replaced(kQuotient, words)) +
      c_header::replaced(changes_function(derating, prefix, lines), {{"@", prefix}}) + possible_values(derating, prefix, swept) +
      "/* Resting temperatures: steady state of the nodes without current in the hottest air, rounded up. */\n" +
      integers("int64_t", prefix + "_resting", resting_temperatures(derating)) + "\n" + c_header::replaced(kStart, words) +
      (swept.empty() ? "" : c_header::replaced(kSweep, words)) + c_header::replaced(kStep, words) + "\n" +
      integer_form::integer_memory(words, heating_inputs(derating, swept)) + "#endif\n");
}

}  // namespace

ExporterType c_header_q15() {
  return {.name = {},
          .summary = "C99 header in integers (16-bit table, 32-bit observer) for controllers without an FPU",
          .usual_ending = ".h",
          .write = write_c_header_q15};
}

}  // namespace heatsoak::derate::exporters
