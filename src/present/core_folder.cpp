#include "present/core_folder.h"

#include <fmt/format.h>

#include "derate/export_text.h"
#include "present/derating.h"
#include "present/parameter_table.h"
#include "present/robot_notes.h"
#include "present/shell_word.h"

namespace heatsoak::present {

Document core_folder_document(const CoreInput& input, const firmware::GeneratedCore& core) {
  const auto& [derating, folder] = core;
  const auto& [robot, motor, options, out] = input;
  std::size_t bytes = 0;
  for (const firmware::CoreFile& file : folder.files) {
    bytes += file.content.size();
  }
  Document document{.headline = {{fmt::format("Drive core for {} with {}: {} files, {} kB in {}.", derating.robot_id, derating.motor_id,
                                              folder.files.size(), bytes / 1024, out)}},
                    .paragraphs = {fmt::format("Safety factor on heat {:.2f}. {}", derating.observer.heat_safety_factor(),
                                               derate::confidence_text(derating, derating.guarantee)),
                                   fmt::format("Next: `make -C {0} host` and `make -C {0} firmware`.", shell_word(out))}};
  Table table = labelled_table("");
  add_labelled(table, "winding limit",
               fmt::format("{:.0f} °C{} in air up to {:.0f} °C, {} thermal data", derating.rules.limits.winding_C,
                           limit_range_words(derating), derating.rules.hottest_ambient_C, derating.data_quality));
  add_labelled(table, "control period", fmt::format("{:.6g} ms, guard {:.6g} ms", 1e3 * options.period_s, 1e3 * derating.options.period_s));
  add_labelled(table, "unknown speed", fmt::format("a wheel whose speed is unknown gets at most {:.2f} A", folder.limp_current_A));
  add_labelled(table, "full stop", fmt::format("{:.1f} K are kept as a margin for one full stop", folder.braking_reserve_K));
  add_labelled(table, "inputs", fmt::format("{} {}", derate::kInputHash, folder.hash));
  add_labelled(table, "configuration", fmt::format("check sum {:08x}", folder.config_check_sum));
  document.tables.push_back(std::move(table));
  for (const firmware::CoreNote& note : folder.notes) {
    document.add_note(firmware::is_unsafe(note) ? Severity::warning : Severity::note, to_string(note));
  }
  add_robot_notes(document, robot);
  document.data = core_folder_json(input, core);
  add_notes(document.data, document.notes);
  return document;
}

}  // namespace heatsoak::present
