// Block diagram of the drive core, drawn from the tables of robot_core/block_diagram.h.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "robot_core/block_diagram.h"

namespace heatsoak::firmware {

/// Returns the rate in words: "every period".
std::string_view rate_words(robot_core::BlockRate rate);

/// Returns the declaration of a block other than the firmware.
const robot_core::BlockText& text_of(robot_core::Block block);

/// Signals that one block writes into one carrier, in the order of the table.
struct SignalGroup {
  std::string_view carrier;
  robot_core::Block from;
  std::vector<robot_core::SignalText> signals;

  /// Returns the blocks that read at least one of these signals.
  [[nodiscard]] robot_core::Blocks readers() const;
};
/// Returns the groups in the order of the blocks that write them.
std::vector<SignalGroup> signal_groups();

/// Returns the numbers of the blocks in the order of the calls: "1 G 4"; "firmware" for the firmware.
std::string numbers_of(robot_core::Blocks blocks);

/// Returns the diagram as SVG: blocks from top to bottom in the order of the calls, signals on lanes beside them. Needs only a sans-serif
/// and a monospaced font.
std::string core_diagram_svg();

}  // namespace heatsoak::firmware
