#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <type_traits>
#include <variant>

#include "base/quantity.h"
#include "present/measured/calibration_words.h"
#include "present/measured/diagnosis_words.h"
#include "present/measured/run_words.h"
#include "present/measured/severity_of_kind.h"

namespace heatsoak::present {
namespace {

std::string_view it_or_them(std::size_t count) { return count == 1 ? "it" : "them"; }

std::string say(const diagnosis::ExtensionsMayImitate& of) {
  return fmt::format(
      "an effect similar to {} may not be found, because the file has {} for better forecasts only; calibrate with --innovations for a "
      "diagnosis",
      fmt::join(of.effects, " and "), it_or_them(of.effects.size()));
}

std::string say(const diagnosis::IntervalsOfDataSheet& /*of*/) {
  return "the file's intervals are replaced by those of a data sheet, because the file was fitted to some of these runs, which would count "
         "twice";
}

std::string say(const diagnosis::HoldoutWasFitted& of) {
  return fmt::format("the errors of {} are not those of an unseen run, because the motor's file was fitted to it", of.recording);
}

std::string say(const diagnosis::LossInUnknownHeat& of) {
  return fmt::format(
      "not every log has a speed: the loss at speed, up to {} W, is part of the unknown heat; no effect at the stator is named, and no "
      "curve over another signal is added",
      base::significant(of.most_W, 2));
}

std::string say(const diagnosis::TorqueFromCurrent& /*of*/) {
  return "not every log has a torque: without one, current times torque constant minus the no-load drag is used";
}

std::string say(const diagnosis::ColumnsNotSearched& of) {
  return fmt::format("not every log has {}: heat that depends on {} is not searched for; to search for it, leave out the other logs",
                     fmt::join(of.columns, ", "), it_or_them(of.columns.size()));
}

}  // namespace

std::string words_of(const diagnosis::DiagnosisFinding& finding) {
  return std::visit(
      [](const auto& each) {
        if constexpr (std::is_constructible_v<calibration::CalibrationFinding, decltype(each)>) {
          return words_of(calibration::CalibrationFinding(each));
        } else {
          return say(each);
        }
      },
      finding);
}

Severity severity_of(const diagnosis::DiagnosisFinding& finding) {
  using namespace diagnosis;
  if (const auto* const note = std::get_if<estimation::RunNote>(&finding)) {
    return severity_of(*note);
  }
  using Warnings = Kinds<ExtensionsMayImitate, calibration::ContradictingRun, calibration::OutsideDeclaredRange,
                         calibration::HeatInputLacking, calibration::ShaftPowerUnknown, calibration::HoldoutDiverges>;
  using Notes = Kinds<calibration::SignalsMissing, IntervalsOfDataSheet, HoldoutWasFitted, LossInUnknownHeat, TorqueFromCurrent,
                      ColumnsNotSearched, calibration::RowsTurn, calibration::HeldValue, estimation::RunNote>;
  return severity_in<Warnings, Notes, Kinds<>>(finding);
}

}  // namespace heatsoak::present
