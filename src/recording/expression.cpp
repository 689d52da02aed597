#include "recording/expression.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <muParser.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <numbers>

namespace heatsoak::recording {
namespace {

const std::vector<std::string>& functions() {
  static const std::vector<std::string> kNames{"abs", "min", "max", "sqrt",  "where", "sign", "exp",  "ln",   "log10",
                                               "sin", "cos", "tan", "atan2", "rint",  "asin", "acos", "atan", "floor"};
  return kNames;
}

bool begins_word(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool is_in_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

double where(double condition, double then_value, double else_value) { return condition != 0.0 ? then_value : else_value; }
double rounded_down(double value) { return std::floor(value); }

/// Rewrites column names to names that muParser accepts (c0_, c1_, …), and finds names that are neither column nor function.
class Rewriter {
 public:
  Rewriter(std::string_view text, std::span<const std::string> header, std::vector<std::size_t>& columns)
      : text_(text), header_(header), columns_(columns) {}

  /// Returns the error, or an empty string. On an error, `at` is its position in the text.
  std::string run() {
    while (at < text_.size()) {
      const char c = text_[at];
      std::string problem;
      if (c == '\'') {
        problem = quoted();
      } else if (begins_word(c)) {
        problem = word();
      } else if (std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '.') {
        number();
      } else if (c == '=' && !is_comparison()) {
        problem = "'=' is an assignment; write == to compare";
      } else {
        out += c;
        ++at;
      }
      if (!problem.empty()) {
        return problem;
      }
    }
    return columns_.empty() ? "names no column" : "";
  }

  std::size_t at = 0;
  std::string out;

 private:
  [[nodiscard]] bool is_comparison() const {
    const char before = at > 0 ? text_[at - 1] : ' ';
    const char after = at + 1 < text_.size() ? text_[at + 1] : ' ';
    return after == '=' || before == '=' || before == '<' || before == '>' || before == '!';
  }

  void number() {
    const std::size_t begin = at;
    while (at < text_.size() && (is_in_word(text_[at]) || text_[at] == '.' ||
                                 ((text_[at] == '+' || text_[at] == '-') && (text_[at - 1] == 'e' || text_[at - 1] == 'E')))) {
      ++at;
    }
    out += text_.substr(begin, at - begin);
  }

  std::string quoted() {
    const std::size_t end = text_.find('\'', at + 1);
    if (end == std::string_view::npos) {
      return "a quote is not closed";
    }
    std::string problem = column(text_.substr(at + 1, end - at - 1));
    at = problem.empty() ? end + 1 : at;
    return problem;
  }

  std::string word() {
    std::size_t end = at;
    while (end < text_.size() && is_in_word(text_[end])) {
      ++end;
    }
    const std::string name(text_.substr(at, end - at));
    const std::size_t next = text_.find_first_not_of(' ', end);
    if (next != std::string_view::npos && text_[next] == '(') {
      if (std::ranges::find(functions(), name) == functions().end()) {
        return fmt::format("there is no function '{}'{}; there are {}", name, base::did_you_mean(name, functions()),
                           fmt::join(functions(), ", "));
      }
      out += name;
    } else if (name == "pi") {
      out += name;
    } else if (std::string problem = column(name); !problem.empty()) {
      return problem;
    }
    at = end;
    return {};
  }

  std::string column(std::string_view name) {
    const auto found = std::ranges::find(header_, name);
    if (found == header_.end()) {
      const std::vector<std::string> names(header_.begin(), header_.end());
      return fmt::format("the log has no column '{}'{}", name, base::did_you_mean(name, names));
    }
    const auto place = static_cast<std::size_t>(found - header_.begin());
    auto known = std::ranges::find(columns_, place);
    if (known == columns_.end()) {
      columns_.push_back(place);
      known = columns_.end() - 1;
    }
    out += fmt::format(" c{}_ ", known - columns_.begin());
    return {};
  }

  std::string_view text_;
  std::span<const std::string> header_;
  std::vector<std::size_t>& columns_;
};

}  // namespace

struct Expression::Compiled {
  mu::Parser parser;
  std::vector<std::vector<double>> inputs;  ///< muParser keeps pointers to these values
};

Expression::Expression(std::string_view text, std::span<const std::string> header, base::Location at, const std::string& key,
                       base::Diagnostics& problems)
    : compiled_(std::make_unique<Compiled>()) {
  Rewriter rewriter(text, header, columns_);
  if (std::string problem = rewriter.run(); !problem.empty()) {
    if (at.column) {
      *at.column += static_cast<int>(rewriter.at) + 1;  // + 1: the opening quote of the TOML text
    }
    problems.add(at, key, fmt::format("\"{}\": {}", text, problem));
    return;
  }
  try {
    compiled_->parser.DefineFun("where", where);
    compiled_->parser.DefineFun("floor", rounded_down);
    compiled_->parser.DefineConst("pi", std::numbers::pi);
    // muParser needs stable addresses: one buffer per column.
    compiled_->inputs.resize(columns_.size(), std::vector<double>(1, 1.0));
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      compiled_->parser.DefineVar(fmt::format("c{}_", i), compiled_->inputs[i].data());
    }
    compiled_->parser.SetExpr(rewriter.out);
    compiled_->parser.Eval();
    is_ok_ = true;
  } catch (const mu::Parser::exception_type& error) {
    problems.add(at, key, fmt::format("\"{}\" is not a valid expression: {}", text, error.GetMsg()));
  }
}

Expression::~Expression() = default;
Expression::Expression(Expression&&) noexcept = default;
Expression& Expression::operator=(Expression&&) noexcept = default;

void Expression::evaluate(std::span<const std::vector<double>* const> columns, std::vector<double>& values) {
  const std::size_t rows = columns[0]->size();
  values.resize(rows);
  if (rows == 0) {
    return;
  }
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const bool moves = compiled_->inputs[i].capacity() < rows;
    compiled_->inputs[i] = *columns[i];
    if (moves) {
      compiled_->parser.DefineVar(fmt::format("c{}_", i), compiled_->inputs[i].data());
    }
  }
  compiled_->parser.Eval(values.data(), static_cast<int>(rows));
  for (const std::vector<double>* column : columns) {
    for (std::size_t row = 0; row < rows; ++row) {
      // min(a, NaN) and comparisons would otherwise hide a blank cell.
      values[row] = std::isnan((*column)[row]) || !std::isfinite(values[row]) ? std::numeric_limits<double>::quiet_NaN() : values[row];
    }
  }
}

}  // namespace heatsoak::recording
