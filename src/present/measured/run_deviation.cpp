#include "present/measured/run_deviation.h"

#include <fmt/format.h>

#include <array>

#include "base/quantity.h"
#include "present/description.h"

namespace heatsoak::present {

std::string typical_size(const estimation::RunDeviationType& type) {
  const std::string_view unit = type.size.unit;
  return fmt::format("{}{}{}", base::significant(type.usual, 3), unit.empty() ? "" : " ", base::unit_for_display(unit));
}

std::string place_of(const estimation::RunDeviationType& type) { return fmt::format("at the {}, in runs of one condition", type.node); }

Document run_deviation_description(const estimation::RunDeviationType& type) {
  const std::array lines{LabelledWords{"equation", std::string(type.equation)}, LabelledWords{"typical size", typical_size(type)},
                         LabelledWords{"confounded", std::string(type.confounded_with)},
                         LabelledWords{"experiment", std::string(type.experiment)}};
  Document document = effect_outside_network(place_of(type), type.name, type.summary, type.size, lines);
  document.paragraphs.emplace_back("Found by `heatsoak diagnose`; it is not part of a motor file.");
  return document;
}

}  // namespace heatsoak::present
