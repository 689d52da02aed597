// House rules that no compiler checks. Each checker must first find a planted violation.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "layer_table.h"
#include "source_text.h"
#include "unit_names.h"

namespace heatsoak::lint {
namespace {

constexpr std::ptrdiff_t kMostLines = 500;
/// Longer files, each with its reason.
const std::map<std::string, std::string> kLongFiles{};

std::set<std::string> folders_of_src() {
  std::set<std::string> folders;
  for (const SourceFile& file : files_in("src")) {
    const std::size_t begin = file.path.find('/') + 1;
    // Files directly in src (the README.md) belong to no folder.
    if (const std::size_t end = file.path.find('/', begin); end != std::string::npos) {
      folders.insert(file.path.substr(begin, end - begin));
    }
  }
  return folders;
}

LayerTable layers_of_tree() {
  for (const SourceFile& file : files_in("")) {
    if (file.path == "CMakeLists.txt") {
      return read_layer_table(file.text, folders_of_src());
    }
  }
  return {};
}

std::vector<std::string> names_of(const std::vector<NamedNumber>& numbers) {
  std::vector<std::string> names;
  for (const NamedNumber& number : numbers) {
    names.push_back(number.name);
  }
  return names;
}

const char* const kSmallTable =
    "add_layer(base USES fmt::fmt)\n"
    "add_layer(upper USES base\n  HIDES lib)\n"
    "add_layer(side USES base)\n"
    "add_plugin(charts src/side/plug USES base HIDES VTK::X)\n";

TEST(Layers, PlantedViolationsAreFound) {
  const LayerTable table = read_layer_table(kSmallTable, {"base", "upper", "side"});
  EXPECT_TRUE(table.problems.empty());
  EXPECT_TRUE(layer_violations(table, "src/upper/a.cpp", "#include <vector>\n#include \"base/b.h\"\n#include \"upper/a.h\"\n").empty());
  EXPECT_EQ(layer_violations(table, "src/base/a.cpp", "#include \"upper/a.h\"\n").size(), 1U);
  EXPECT_EQ(layer_violations(table, "src/upper/a.cpp", "\n#include \"side/a.h\"\n"),
            std::vector<std::string>{"src/upper/a.cpp:2: \"side/a.h\" is of no layer that this file may use"});
  EXPECT_EQ(layer_violations(table, "src/upper/a.cpp", "#include \"a.h\"\n").size(), 1U);
  EXPECT_EQ(layer_violations(table, "src/other/a.cpp", "").size(), 1U);
}

TEST(Layers, PluginSharesHeadersButIsNotIncluded) {
  const LayerTable table = read_layer_table(kSmallTable, {"base", "upper", "side"});
  EXPECT_TRUE(layer_violations(table, "src/side/plug/a.cpp", "#include \"side/a.h\"\n#include \"side/plug/a.h\"\n").empty());
  EXPECT_EQ(layer_violations(table, "src/side/plug/a.cpp", "#include \"upper/a.h\"\n").size(), 1U);
  EXPECT_EQ(layer_violations(table, "src/side/a.cpp", "#include \"side/plug/a.h\"\n").size(), 1U);
}

TEST(Layers, LibrariesStayInTheirFolder) {
  const LayerTable table = read_layer_table(kSmallTable, {"base", "upper", "side"});
  for (const char* header : {"vtkChartXY.h", "cvodes/cvodes.h", "nvector/nvector_serial.h", "toml++/toml.h", "CLI/App.hpp", "csv.h"}) {
    EXPECT_EQ(layer_violations(table, "src/upper/a.cpp", "#include <" + std::string(header) + ">\n").size(), 1U) << header;
  }
}

TEST(Layers, UseOfALayerBelowTheLineIsFound) {
  EXPECT_EQ(read_layer_table("add_layer(a USES b)\nadd_layer(b USES a)\n", {"a", "b"}).problems.size(), 1U);
}

TEST(Layers, TreeKeepsToTheTable) {
  const LayerTable table = layers_of_tree();
  ASSERT_FALSE(table.uses.empty());
  for (const std::string& problem : table.problems) {
    ADD_FAILURE() << problem;
  }
  for (const SourceFile& file : files_in("src")) {
    // Templates are compiled elsewhere and include the files beside them there. The README contains no includes.
    if (file.path.find("/templates/") != std::string::npos || file.path.find("/fmi/sources/") != std::string::npos ||
        file.path == "src/README.md") {
      continue;
    }
    for (const std::string& violation : layer_violations(table, file.path, file.text)) {
      ADD_FAILURE() << violation;
    }
  }
}

TEST(Layers, PlantedNamespacesAreFound) {
  EXPECT_TRUE(namespace_violations("src/upper/a.h", "namespace heatsoak::base {\nclass A;\n}\n\nnamespace heatsoak::upper {\n").empty());
  EXPECT_TRUE(namespace_violations("src/upper/shapes/a.cpp", "namespace heatsoak::upper::shapes {\nnamespace {\n").empty());
  EXPECT_EQ(namespace_violations("src/upper/a.h", "\nnamespace heatsoak::upper_side {\n"),
            std::vector<std::string>{"src/upper/a.h: opens heatsoak::upper_side instead of heatsoak::upper"});
  EXPECT_EQ(namespace_violations("src/upper/a.h", "namespace heatsoak {\n\nclass A;\n").size(), 1U);
}

TEST(Layers, NamespacesAreThoseOfTheFolders) {
  for (const SourceFile& file : files_in("src")) {
    for (const std::string& violation : namespace_violations(file.path, file.text)) {
      ADD_FAILURE() << violation;
    }
  }
}

TEST(UnitNames, FieldsAndParametersAreSeen) {
  const char* const header = R"(
    // double in_comment;
    struct A { double a = 0.0; std::vector<double> b, c; std::optional<double> d; const float* e = nullptr; int no; };
    double no_function(double f, const std::span<const double>& g, int no, std::array<double, 3> h);
    std::function<void(double i)> no_callback;
    std::map<std::string, std::vector<double>> j_;
    std::vector<std::vector<double>> k;  ///< double no;
    double A::* l;
    const char* text = "double no;";
    [[nodiscard]] double no_getter() const { return a_; }
    template <class S> void law(const S* m, std::span<S> n);
    void no_own_template(const Point<double>& no, std::vector<Point<double>>& neither);
    double o{1.0};
    unsigned long p = 1'000; double q;
  )";
  const std::vector<std::string> expected{"a", "b", "c", "d", "e", "f", "g", "h", "i", "j_", "k", "l", "m", "n", "o", "q"};
  EXPECT_EQ(names_of(floating_point_names(header)), expected);
}

TEST(UnitNames, UnitsAreRecognised) {
  for (const char* name : {"current_A", "resistance_25C_ohm", "thermal_resistance_K_per_W", "temperature_coefficient_per_K", "state_C_",
                           "speed_constant_rad_per_s_per_V", "rotor_inertia_kg_m2", "drag_Nm", "acceleration_m_per_s2"}) {
    EXPECT_TRUE(ends_in_unit(name)) << name;
  }
  for (const char* name : {"current", "currentA", "A", "s", "_s", "temperature_c", "speed_per_", "resistance_Ohm", "status"}) {
    EXPECT_FALSE(ends_in_unit(name)) << name;
  }
  EXPECT_TRUE(is_unitless_by_nature("gear_ratio"));
  EXPECT_TRUE(is_unitless_by_nature("parameters_"));
  EXPECT_FALSE(is_unitless_by_nature("current"));
}

TEST(UnitNames, HeadersOfTheTreeNameTheirUnits) {
  for (const char* folder : {"src", "robot_core"}) {
    for (const SourceFile& file : files_in(folder)) {
      if (!file.path.ends_with(".h")) {
        continue;
      }
      for (const NamedNumber& number : floating_point_names(file.text)) {
        EXPECT_TRUE(ends_in_unit(number.name) || is_unitless_by_nature(number.name))
            << file.path << ":" << number.line << ": '" << number.name << "' does not end in its unit";
      }
    }
  }
}

TEST(Files, AreShortEnoughToRead) {
  for (const char* folder : {"src", "robot_core"}) {
    for (const SourceFile& file : files_in(folder)) {
      const auto lines = std::ranges::count(file.text, '\n');
      EXPECT_TRUE(lines <= kMostLines || kLongFiles.contains(file.path)) << file.path << " has " << lines << " lines";
    }
  }
}

TEST(Files, OfMotorsRobotsDutiesAndReportsHaveNoLongLines) {
  constexpr std::size_t kLongestLine = 160;
  for (const char* folder : {"motor_db", "robot_core/robots", "duty_profiles", "reports", "tests/data/lint_motors"}) {
    for (const SourceFile& file : files_in(folder)) {
      int line = 1;
      for (std::size_t begin = 0; file.path.ends_with(".toml") && begin < file.text.size(); ++line) {
        const std::size_t end = std::min(file.text.find('\n', begin), file.text.size());
        EXPECT_LE(end - begin, kLongestLine) << file.path << ":" << line << ": break the longest text as \"\"\"\\";
        begin = end + 1;
      }
    }
  }
}

/// Split literals, so that this file does not contain its own patterns.
const std::regex kLeftover(
    "\\b(TO"
    "DO|FIX"
    "ME|X"
    "XX)\\b");
const std::regex kPathOfAMachine(
    "(^|[\\s\"'`=(<])/(wo"
    "rk|ho"
    "me|ro"
    "ot|Us"
    "ers)/[A-Za-z0-9]");

TEST(Files, PlantedLeftoversAreFound) {
  EXPECT_TRUE(std::regex_search(std::string("// TO") + "DO: later", kLeftover));
  EXPECT_TRUE(std::regex_search(std::string("see \"/ho") + "me/somebody/x\"", kPathOfAMachine));
  EXPECT_FALSE(std::regex_search("https://example.org/work/x and src/work/x", kPathOfAMachine));
}

TEST(Files, HoldNoLeftoversAndNoPathOfAMachine) {
  for (const SourceFile& file : files_in("")) {
    int line = 1;
    for (std::size_t begin = 0; begin < file.text.size(); ++line) {
      const std::size_t end = std::min(file.text.find('\n', begin), file.text.size());
      // Long lines are data, and std::regex recurses for each character.
      if (const std::string text = file.text.substr(begin, std::min<std::size_t>(end - begin, 2000));
          std::regex_search(text, kLeftover) || std::regex_search(text, kPathOfAMachine)) {
        ADD_FAILURE() << file.path << ":" << line << ": " << text;
      }
      begin = end + 1;
    }
  }
}

}  // namespace
}  // namespace heatsoak::lint
