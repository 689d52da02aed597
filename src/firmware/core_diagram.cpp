#include "firmware/core_diagram.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>

#include "base/xml_text.h"

namespace heatsoak::firmware {
namespace {

using robot_core::Block;
using robot_core::Blocks;
using robot_core::BlockText;
using robot_core::SignalText;

// All lengths in px.
constexpr double kMargin_px = 24.0;
constexpr double kHead_px = 108.0;
constexpr double kRowGap_px = 34.0;
constexpr double kLane_px = 15.0;
constexpr double kLabel_px = 132.0;  // between the innermost lane and a block, with space for the name of a carrier
constexpr double kBlock_px = 300.0;
constexpr double kSide_px = 268.0;  // width of a block beside the stages
constexpr double kLine_px = 16.0;
constexpr double kSlot_px = 19.0;
constexpr double kMono_px = 6.63;  // advance of a monospaced letter of 11 px, which is 0.602 of its size in DejaVu Sans Mono
constexpr double kPad_px = 10.0;

constexpr std::array<const char*, 8> kPalette{"#1f5fa8", "#b3470f", "#2c7a3f", "#7a3a94", "#8a6500", "#0f7480", "#a3224f", "#4c4c4c"};

struct Box {
  double left_px = 0.0;
  double top_px = 0.0;
  double width_px = 0.0;
  double height_px = 0.0;

  [[nodiscard]] double right_px() const { return left_px + width_px; }
  [[nodiscard]] double bottom_px() const { return top_px + height_px; }
};

/// End of a lane at the edge of a block, at the height `y_px`.
struct Tap {
  Block block;
  bool is_source = false;
  double y_px = 0.0;
};

/// A group of signals with its card, its vertical lane and the blocks at which it ends.
struct Lane {
  SignalGroup group;
  bool is_left = false;
  Box card;
  double card_y_px = 0.0;  ///< height of the line from the lane to the card
  double x_px = 0.0;
  std::vector<Tap> taps;
  std::string color;

  [[nodiscard]] double top_px() const;
  [[nodiscard]] double bottom_px() const;
};

double Lane::top_px() const {
  double top = card_y_px;
  for (const Tap& tap : taps) {
    top = std::min(top, tap.y_px);
  }
  return top;
}

double Lane::bottom_px() const {
  double bottom = card_y_px;
  for (const Tap& tap : taps) {
    bottom = std::max(bottom, tap.y_px);
  }
  return bottom;
}

std::size_t letters(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

bool is_side(Block block) { return block == Block::run_guards || block == Block::plan_to_pose; }

std::vector<std::string_view> files_of(const BlockText& block) {
  std::vector<std::string_view> files;
  std::string_view rest = block.files;
  for (std::size_t comma = rest.find(", "); comma != std::string_view::npos; comma = rest.find(", ")) {
    files.push_back(rest.substr(0, comma));
    rest.remove_prefix(comma + 2);
  }
  files.push_back(rest);
  return files;
}

/// Column positions of the cards, which are as wide as their longest text.
struct Columns {
  double unit_px = 0.0;  ///< distance from the card's left edge
  double to_px = 0.0;
  double width_px = 0.0;
};

Columns columns_of(const std::vector<SignalGroup>& groups) {
  std::size_t name = 0;
  std::size_t unit = 0;
  std::size_t to = 0;
  for (const SignalGroup& group : groups) {
    for (const SignalText& signal : group.signals) {
      name = std::max(name, letters(signal.name));
      unit = std::max(unit, letters(signal.unit));
      to = std::max(to, letters(numbers_of(signal.to)));
    }
  }
  Columns columns;
  columns.unit_px = 2.0 * kPad_px + kMono_px * static_cast<double>(name);
  columns.to_px = columns.unit_px + kPad_px + kMono_px * static_cast<double>(unit);
  columns.width_px = columns.to_px + kPad_px + kMono_px * static_cast<double>(std::max<std::size_t>(to, 7));
  return columns;
}

/// Layout: positions of the blocks, cards and lanes.
class Plan {
 public:
  Plan() : columns_(columns_of(signal_groups())) {
    for (SignalGroup& group : signal_groups()) {
      Lane lane;
      lane.is_left = group.carrier == "Input" || group.carrier == "State";
      lane.group = std::move(group);
      lanes_.push_back(std::move(lane));
    }
    set_columns();
    for (const BlockText& block : robot_core::kBlocks) {
      add_row(block);
    }
    set_lanes();
  }

  [[nodiscard]] const std::vector<Lane>& lanes() const { return lanes_; }
  [[nodiscard]] const Columns& columns() const { return columns_; }
  [[nodiscard]] const Box& box(Block block) const { return boxes_.at(block); }
  [[nodiscard]] double width_px() const { return 2.0 * kMargin_px + 2.0 * columns_.width_px + inner_px(); }
  [[nodiscard]] double height_px() const { return bottom_px_ - kRowGap_px + kMargin_px; }

 private:
  [[nodiscard]] double count(bool is_left) const {
    return static_cast<double>(std::ranges::count(lanes_, is_left, [](const Lane& lane) { return lane.is_left; }));
  }
  [[nodiscard]] double side_px(bool is_left) const { return kLane_px * (count(is_left) + 1.0) + kLabel_px; }
  [[nodiscard]] double inner_px() const { return side_px(true) + kBlock_px + side_px(false); }

  void set_columns() {
    block_left_px_ = kMargin_px + columns_.width_px + side_px(true);
    bottom_px_ = kHead_px;
  }

  /// Returns whether the card of a group belongs to this row: that of the block that writes it, or the first row for signals of the
  /// firmware.
  [[nodiscard]] static bool is_in_row(const Lane& lane, Block row) {
    return lane.group.from == row || (lane.group.from == Block::firmware && row == Block::validate_input);
  }

  double stack_cards(Block row, bool is_left) {
    double y = bottom_px_;
    for (Lane& lane : lanes_) {
      if (lane.is_left != is_left || !is_in_row(lane, row)) {
        continue;
      }
      const double height = kLine_px * (static_cast<double>(lane.group.signals.size()) + 1.0) + 1.6 * kPad_px;
      lane.card = {is_left ? kMargin_px : width_px() - kMargin_px - columns_.width_px, y, columns_.width_px, height};
      y += height + kPad_px;
    }
    return y - bottom_px_ - kPad_px;
  }

  /// Adds the ends of the lanes at one edge of a block, outgoing ones first. Returns the height that they need.
  double add_taps(Block block, bool is_left) {
    double slots = 0.0;
    for (const bool is_source : {true, false}) {
      for (Lane& lane : lanes_) {
        const bool is_here = is_source ? lane.group.from == block : contains(lane.group.readers(), block);
        if (lane.is_left == is_left && is_here) {
          lane.taps.push_back({block, is_source, bottom_px_ + 21.0 + kSlot_px * slots});
          slots += 1.0;
        }
      }
    }
    return 21.0 + kSlot_px * slots;
  }

  void add_row(const BlockText& block) {
    const double text = 68.0 + kLine_px * static_cast<double>(files_of(block).size());
    const double taps = std::max(add_taps(block.block, true), add_taps(block.block, false));
    const double height = std::max(text, taps);
    const double cards = std::max(stack_cards(block.block, true), stack_cards(block.block, false));
    boxes_[block.block] = {block_left_px_, bottom_px_, is_side(block.block) ? kSide_px : kBlock_px, height};
    bottom_px_ += std::max(height, cards) + kRowGap_px;
  }

  /// Places the longest lanes outermost, so that they cross fewer ends of other lanes.
  void set_lanes() {
    std::map<bool, double> used;
    std::vector<Lane*> order;
    for (Lane& lane : lanes_) {
      const Box& card = lane.card;
      const auto own = std::ranges::find_if(lane.taps, [&](const Tap& tap) {
        return (tap.is_source || lane.group.from == Block::firmware) && tap.y_px > card.top_px && tap.y_px < card.bottom_px();
      });
      lane.card_y_px = own != lane.taps.end() ? own->y_px : card.top_px + 0.5 * card.height_px;
      order.push_back(&lane);
    }
    std::ranges::stable_sort(order, std::greater(), [](const Lane* lane) { return lane->bottom_px() - lane->top_px(); });
    std::map<bool, std::size_t> color;
    for (Lane* const lane : order) {
      const double offset = kLane_px * (used[lane->is_left] += 1.0);
      const double outer = kMargin_px + columns_.width_px + offset;
      lane->x_px = lane->is_left ? outer : width_px() - outer;
      lane->color = kPalette[color[lane->is_left]++ % kPalette.size()];
    }
  }

  Columns columns_;
  std::vector<Lane> lanes_;
  std::map<Block, Box> boxes_;
  double block_left_px_ = 0.0;
  double bottom_px_ = 0.0;
};

/// Collects the elements of an SVG picture.
class Picture {
 public:
  void rectangle(const Box& box, std::string_view style, double radius_px) {
    text_ += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" rx=\"{:.0f}\" {}/>\n", box.left_px, box.top_px,
                         box.width_px, box.height_px, radius_px, style);
  }
  void write(double x_px, double y_px, std::string_view kind, std::string_view words, std::string_view style = {}) {
    text_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"{}\"{}{}>{}</text>\n", x_px, y_px, kind, style.empty() ? "" : " ", style,
                         base::xml_text(words));
  }
  /// Draws a line with a white outline, which interrupts the lines that it crosses.
  void line(double from_x_px, double from_y_px, double to_x_px, double to_y_px, std::string_view color) {
    const std::string path = fmt::format("x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"", from_x_px, from_y_px, to_x_px, to_y_px);
    text_ +=
        fmt::format("<line {} stroke=\"#fff\" stroke-width=\"5\"/>\n<line {} stroke=\"{}\" stroke-width=\"1.6\"/>\n", path, path, color);
  }
  void dot(double x_px, double y_px, std::string_view color) {
    text_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>\n", x_px, y_px, color);
  }
  /// Draws an arrowhead with its tip at x, pointing to the right or to the left.
  void arrowhead(double x_px, double y_px, bool is_to_right, std::string_view color) {
    const double back = is_to_right ? -8.0 : 8.0;
    text_ += fmt::format("<path d=\"M{:.1f} {:.1f} l{:.0f} -4 v8 z\" fill=\"{}\"/>\n", x_px, y_px, back, color);
  }
  void arrow_down(double x_px, double from_y_px, double to_y_px) {
    text_ += fmt::format(
        "<line x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{0:.1f}\" y2=\"{2:.1f}\" stroke=\"#c4c9d0\" stroke-width=\"7\"/>\n"
        "<path d=\"M{0:.1f} {3:.1f} l-10 -11 h20 z\" fill=\"#c4c9d0\"/>\n",
        x_px, from_y_px, to_y_px - 10.0, to_y_px);
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

constexpr std::string_view kStyle =
    "<style>text{font-family:'DejaVu Sans',Verdana,sans-serif;fill:#1b1f24}.h1{font-size:20px;font-weight:bold}.h2{font-size:12px}"
    ".title{font-size:14px;font-weight:bold}.small{font-size:11px}.mono{font-family:'DejaVu Sans Mono',Consolas,monospace;font-size:11px}"
    ".head{font-family:'DejaVu Sans Mono',Consolas,monospace;font-size:11px;font-weight:bold}"
    ".no{font-size:13px;font-weight:bold;text-anchor:middle}</style>\n";

void draw_card(const Lane& lane, const Columns& columns, Picture& picture) {
  const Box& card = lane.card;
  picture.rectangle(card, fmt::format("fill=\"#fff\" stroke=\"{}\" stroke-width=\"1.2\"", lane.color), 3.0);
  double y = card.top_px + kLine_px + 0.2 * kPad_px;
  const bool is_input = lane.group.from == Block::firmware;
  const std::string head =
      is_input ? std::string("Input, from the firmware") : fmt::format("{}, by {}", lane.group.carrier, text_of(lane.group.from).number);
  const std::string color = fmt::format("style=\"fill:{}\"", lane.color);
  picture.write(card.left_px + kPad_px, y, "head", head, color);
  picture.write(card.left_px + columns.unit_px, y, "mono", "unit", color);
  picture.write(card.left_px + columns.to_px, y, "mono", "read by", color);
  for (const SignalText& signal : lane.group.signals) {
    y += kLine_px;
    picture.write(card.left_px + kPad_px, y, "mono", signal.name);
    picture.write(card.left_px + columns.unit_px, y, "mono", signal.unit);
    picture.write(card.left_px + columns.to_px, y, "mono", numbers_of(signal.to));
  }
}

void draw_lane(const Plan& plan, const Lane& lane, Picture& picture) {
  const double card_x = lane.is_left ? lane.card.right_px() : lane.card.left_px;
  picture.line(lane.x_px, lane.card_y_px, card_x, lane.card_y_px, lane.color);
  for (const Tap& tap : lane.taps) {
    const Box& box = plan.box(tap.block);
    const double edge = lane.is_left ? box.left_px : box.right_px();
    picture.line(lane.x_px, tap.y_px, edge, tap.y_px, lane.color);
    if (!tap.is_source) {
      picture.arrowhead(edge, tap.y_px, lane.is_left, lane.color);
    }
    const std::string name =
        lane.group.carrier == "State" ? fmt::format("State, by {}", text_of(lane.group.from).number) : std::string(lane.group.carrier);
    const double beside = lane.is_left ? box.left_px - kLabel_px + 6.0 : box.left_px + kBlock_px + 12.0;
    picture.write(beside, tap.y_px - 4.0, "small", name, fmt::format("style=\"fill:{}\"", lane.color));
  }
  if (lane.group.carrier == "Output") {
    picture.arrowhead(card_x, lane.card_y_px, !lane.is_left, lane.color);
  }
  for (const Tap& tap : lane.taps) {
    picture.dot(lane.x_px, tap.y_px, lane.color);
  }
}

void draw_block(const BlockText& block, const Box& box, Picture& picture) {
  const bool side = is_side(block.block);
  picture.rectangle(box,
                    side ? "fill=\"#fff4e0\" stroke=\"#b07a1e\" stroke-width=\"1.6\" stroke-dasharray=\"6 3\""
                         : "fill=\"#e9f0f9\" stroke=\"#33557f\" stroke-width=\"1.8\"",
                    side ? 12.0 : 4.0);
  const double x = box.left_px + 42.0;
  picture.dot(box.left_px + 23.0, box.top_px + 22.0, "#fff");
  picture.write(box.left_px + 23.0, box.top_px + 26.0, "no", block.number);
  picture.write(x, box.top_px + 24.0, "title", block.title);
  picture.write(x, box.top_px + 42.0, "mono", fmt::format("{}()", block.function));
  double y = box.top_px + 42.0;
  for (const std::string_view file : files_of(block)) {
    y += kLine_px;
    picture.write(x, y, "mono", file, "style=\"fill:#5a6370\"");
  }
  picture.write(x, y + kLine_px, "small", rate_words(block.rate));
}

/// Draws arrows for the order of the calls; they bypass the blocks that are no stages.
void draw_order(const Plan& plan, Picture& picture) {
  const Box* before = nullptr;
  for (const BlockText& block : robot_core::kBlocks) {
    if (is_side(block.block)) {
      continue;
    }
    const Box& box = plan.box(block.block);
    if (before != nullptr) {
      picture.arrow_down(box.left_px + 0.5 * (kSide_px + kBlock_px), before->bottom_px(), box.top_px);
    }
    before = &box;
  }
}

}  // namespace

std::string_view rate_words(robot_core::BlockRate rate) {
  switch (rate) {
    case robot_core::BlockRate::every_guard_period:
      return "once per guard period and wheel";
    case robot_core::BlockRate::every_second_period:
      return "every second control period";
    case robot_core::BlockRate::every_period_of_command:
      return "every period of a pose target";
    default:
      return "every control period";
  }
}

const BlockText& text_of(Block block) { return *std::ranges::find(robot_core::kBlocks, block, &BlockText::block); }

Blocks SignalGroup::readers() const {
  Blocks all = 0;
  for (const SignalText& signal : signals) {
    all |= signal.to;
  }
  return all;
}

std::vector<SignalGroup> signal_groups() {
  std::vector<SignalGroup> groups;
  for (const SignalText& signal : robot_core::kSignals) {
    const auto same = [&](const SignalGroup& group) { return group.carrier == signal.carrier && group.from == signal.from; };
    auto found = std::ranges::find_if(groups, same);
    if (found == groups.end()) {
      found = groups.insert(groups.end(), {signal.carrier, signal.from, {}});
    }
    found->signals.push_back(signal);
  }
  std::ranges::stable_sort(groups, {}, &SignalGroup::from);
  return groups;
}

std::string numbers_of(Blocks blocks) {
  std::string text = contains(blocks, Block::firmware) ? "firmware" : "";
  for (const BlockText& block : robot_core::kBlocks) {
    if (contains(blocks, block.block)) {
      text += fmt::format("{}{}", text.empty() ? "" : " ", block.number);
    }
  }
  return text;
}

std::string core_diagram_svg() {
  const Plan plan;
  Picture picture;
  picture.write(kMargin_px, 36.0, "h1", "Drive core: blocks and signals of one call of robot_core::step()");
  picture.write(
      kMargin_px, 56.0, "h2",
      "From top to bottom: order of the calls (1 to 7), with thermal guard (G) and planner (P) beside the stages. Each frame lists "
      "the signals of one line with their units and the blocks that read them.");
  picture.write(kMargin_px, 73.0, "h2",
                "State is kept between two calls: a block above the one that wrote a signal reads that of the period before. Configuration "
                "is constant and not drawn.");
  picture.write(kMargin_px, 90.0, "h2",
                "Blocks of every second control period run in every period unless the command is a body velocity: its result serves two.");
  draw_order(plan, picture);
  for (const Lane& lane : plan.lanes()) {
    picture.line(lane.x_px, lane.top_px(), lane.x_px, lane.bottom_px(), lane.color);
  }
  for (const Lane& lane : plan.lanes()) {
    draw_lane(plan, lane, picture);
  }
  for (const Lane& lane : plan.lanes()) {
    draw_card(lane, plan.columns(), picture);
  }
  for (const BlockText& block : robot_core::kBlocks) {
    draw_block(block, plan.box(block.block), picture);
  }
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} {1:.0f}\">\n{2}"
      "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n{3}</svg>\n",
      plan.width_px(), plan.height_px(), kStyle, picture.text());
}

}  // namespace heatsoak::firmware
