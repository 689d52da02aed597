#include <fmt/format.h>

#include "derate/c_header/c_text.h"
#include "derate/c_header/parts.h"

namespace heatsoak::derate::c_header {

std::string_view name_of(observed::Signal signal) { return observed::signals()[static_cast<std::size_t>(signal)].name; }

std::vector<observed::Signal> used_signals(const Observer& observer) {
  std::vector<observed::Signal> used;
  for (std::size_t i = 0; i < observed::kSignalCount; ++i) {
    if (observer.uses(static_cast<observed::Signal>(i))) {
      used.push_back(static_cast<observed::Signal>(i));
    }
  }
  return used;
}

std::string structures(const Source& source) {
  const Observer& observer = source.derating.observer;
  std::string text = "typedef struct {\n";
  for (const observed::Signal signal : source.signals) {
    text += fmt::format("  float {}; /* {} */\n", name_of(signal), observed::signals()[static_cast<std::size_t>(signal)].meaning);
  }
  text +=
      fmt::format("}} {}_input;\n\ntypedef struct {{\n  uint32_t started;\n  float state_C[{}]; /*", source.prefix, observer.state_count());
  for (const std::string& name : observer.state_names()) {
    text += fmt::format(" {}", in_comment(name));
  }
  text += fmt::format(
      ": safety factor on heat {2:.3g} */\n"
      "  float carry_K[{1}];\n"
      "  float nominal_C[{1}]; /* the same for a motor with nominal values */\n"
      "  float nominal_carry_K[{1}];\n"
      "}} {0}_state;\n"
      "\n"
      "typedef enum {{\n"
      "  {0}_full,          /* all that a cold motor may draw at this speed, or the driver's largest current */\n"
      "  {0}_derated,       /* less, because the winding or the stator is hot */\n"
      "  {0}_no_current,    /* at the limit, or above the highest speed of the table */\n"
      "  {0}_input_unknown, /* an input was NaN or implausible: its hottest case was used */\n"
      "  {0}_not_started    /* the state was not started or damaged: taken as hot as the limit */\n"
      "}} {0}_reason;\n"
      "\n"
      "typedef struct {{\n"
      "  float allowed_current_A; /* A, equivalent DC current, magnitude, until the next step */\n"
      "  float guarded_winding_C; /* degC, pessimistic: safety factor on heat {2:.3g}, for the hottest drawn motors; sets the allowed "
      "current */\n"
      "  float nominal_winding_C; /* degC, motor with nominal values, safety factor 1; for display and logs only. An unknown input takes "
      "its\n"
      "                              hottest case here too */\n"
      "  {0}_reason reason;\n"
      "}} {0}_output;\n"
      "\n",
      source.prefix, observer.state_count(), observer.heat_safety_factor());
  return text;
}

}  // namespace heatsoak::derate::c_header
