#include "present/steady.h"

#include <fmt/format.h>

#include "base/quantity.h"
#include "motor/datasheet_network.h"
#include "present/motor_notes.h"
#include "thermal/transient.h"

namespace heatsoak::present {
namespace {

Text headline(const motor::OnOffAnswer& answer) {
  const thermal::PeriodicState& periodic = answer.periodic;
  const std::string& id = answer.motor.id;
  if (periodic.destroyed_s) {
    return {
        fmt::format("{} is destroyed: thermal runaway within one cycle, {:.0f} °C are exceeded {:.3g} s after the current is switched on.",
                    id, thermal::kDestroyed_C, *periodic.destroyed_s),
        Tone::bad};
  }
  if (periodic.runaway) {
    return {fmt::format("{} has no steady state: thermal runaway, it gets hotter from cycle to cycle.", id), Tone::bad};
  }
  return {fmt::format("{} reaches at most {:.1f} °C in the steady state (winding limit {:.0f} °C, {}).", id,
                      periodic.peak_C[motor::states::winding], answer.motor.nominal.winding_limit_C,
                      answer.is_over_limit ? "exceeded" : "kept"),
          answer.is_over_limit ? Tone::bad : Tone::good};
}

void add_temperatures(Document& document, const motor::OnOffAnswer& answer) {
  const thermal::PeriodicState& periodic = answer.periodic;
  const auto shown = [](double value_C) { return Text{fmt::format("{:.1f}", value_C)}; };
  Table table{.columns = {{"", "", 0, Alignment::left}, {"mean", "°C", 0}, {"highest", "°C", 0}}};
  table.rows.push_back({{"winding"}, shown(periodic.mean_C[motor::states::winding]), shown(periodic.peak_C[motor::states::winding])});
  table.rows.push_back({{"stator"}, shown(periodic.mean_C[motor::states::stator]), shown(periodic.peak_C[motor::states::stator])});
  if (!answer.under_rms.runaway) {
    table.rows.push_back({{answer.is_of_the_equations ? "winding, equations (8) to (12)" : "winding, rms current held"},
                          shown(answer.under_rms.winding_C),
                          {"–"}});
    table.rows.push_back({{answer.is_of_the_equations ? "stator, equations (8) to (12)" : "stator, rms current held"},
                          shown(answer.under_rms.stator_C),
                          {"–"}});
    document.add_note(Severity::background,
                      fmt::format("{} are exact for cycles that are short against the winding's time constant of {:.3g} s.",
                                  answer.is_of_the_equations ? "Equations (8) to (12)" : "The values under the rms current",
                                  answer.motor.nominal.thermal_time_constant_winding_s));
  }
  document.tables.push_back(std::move(table));
}

}  // namespace

Document steady_document(const motor::OnOffAnswer& answer) {
  Document document{
      .headline = {headline(answer)},
      .paragraphs = {fmt::format("{} A for {} s, then 0 A for {} s: rms current {:.2f} A, ambient {:.0f} °C, {} thermal data.",
                                 base::significant(answer.current.current_on_A, 4), base::significant(answer.current.time_on_s, 4),
                                 base::significant(answer.current.time_off_s, 4), answer.under_rms.current_rms_A, answer.current.ambient_C,
                                 motor::data_quality(answer.motor))}};
  if (!answer.is_runaway() && !answer.periodic.destroyed_s) {
    add_temperatures(document, answer);
  }
  add_motor_notes(document, {&answer.motor, 1});
  document.data = steady_json(answer);
  add_notes(document.data, document.notes);
  return document;
}

}  // namespace heatsoak::present
