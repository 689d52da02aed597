#include "recording/recording_report.h"

namespace heatsoak::recording {

std::string_view to_string(LeftOutReason reason) {
  switch (reason) {
    case LeftOutReason::wrong_number_of_cells:
      return "number of cells differs from the header";
    case LeftOutReason::cut_off:
      return "truncated at the end of the file";
    case LeftOutReason::without_time:
      return "no time";
    case LeftOutReason::time_does_not_increase:
      return "time repeated or running backwards";
    case LeftOutReason::not_valid:
      return "not valid according to the mapping";
    case LeftOutReason::not_recorded:
      return "blank";
    case LeftOutReason::not_a_number:
      return "not a number";
    case LeftOutReason::impossible:
      return "outside the possible range";
    case LeftOutReason::saturated:
      return "saturated";
    case LeftOutReason::frozen:
      return "frozen";
    case LeftOutReason::outlier:
      return "outlier";
  }
  return "?";
}

void LeftOut::add(int line) {
  ++count;
  if (!lines.empty() && line <= lines.back().last + 1) {
    lines.back().last = line;
  } else if (lines.size() < kMostRanges) {
    lines.push_back({line, line});
  }
}

const LeftOut* RecordingReport::find(std::string_view quantity, LeftOutReason reason) const {
  const auto found = left_out.find({std::string(quantity), reason});
  return found == left_out.end() ? nullptr : &found->second;
}

}  // namespace heatsoak::recording
