// Interpreter for the part of LispBM that an exported script uses, in single precision. It runs the script for a comparison with the host's
// results.
#pragma once

#include <cmath>
#include <functional>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace heatsoak::derate {

/// Throws std::runtime_error on an unknown name, so that a script with a wrong name fails.
class SmallLisp {
 public:
  using Extension = std::function<float(const std::vector<float>&)>;

  struct Node {
    std::string atom;  ///< empty for a list
    std::vector<Node> items;
  };

  std::map<std::string, Extension> extensions;
  std::map<std::string, float> settings;  ///< values set by conf-set

  /// Runs the definitions and keeps the body of `loopwhile` for cycle().
  void load(const std::string& script) {
    std::string words;
    for (std::istringstream lines(script); std::getline(lines, line_);) {
      for (const char c : line_.substr(0, line_.find(';')) + " ") {
        words += std::string("(){}").find(c) == std::string::npos ? std::string(1, c) : std::string(" ") + c + " ";
      }
    }
    std::istringstream in(words);
    while (in >> std::ws && in.peek() != std::istringstream::traits_type::eof()) {
      const Node node = read(in);
      if (!node.items.empty() && node.items[0].atom == "loopwhile") {
        loop_ = node.items.at(2);
      } else {
        run(node, globals_);
      }
    }
  }
  void cycle() { run(loop_, globals_); }
  float value(const std::string& name) const { return globals_.at(name); }
  void set(const std::string& name, float value) { globals_.at(name) = value; }

 private:
  using Scope = std::map<std::string, float>;

  Node read(std::istringstream& in) {
    std::string word;
    if (!(in >> word)) {
      throw std::runtime_error("a list does not end");
    }
    if (word != "(" && word != "{") {
      if (word == ")" || word == "}") {
        throw std::runtime_error("a list ends that did not begin");
      }
      return {word, {}};
    }
    const std::string end = word == "(" ? ")" : "}";
    Node list;
    if (word == "{") {
      list.items.push_back({"progn", {}});
    }
    while (true) {
      if (!(in >> std::ws) || in.peek() == std::istringstream::traits_type::eof()) {
        throw std::runtime_error("a list does not end");
      }
      if (static_cast<char>(in.peek()) == end[0]) {
        in >> word;
        return list;
      }
      list.items.push_back(read(in));
    }
  }

  float atom(const std::string& text, const Scope& scope) const {
    if (const auto local = scope.find(text); local != scope.end()) {
      return local->second;
    }
    if (const auto global = globals_.find(text); global != globals_.end()) {
      return global->second;
    }
    std::size_t used = 0;
    const float number = std::stof(text, &used);
    if (used != text.size() || text.find('.') == std::string::npos) {
      throw std::runtime_error("no float: " + text);
    }
    return number;
  }

  float run(const Node& node, Scope& scope) {
    if (!node.atom.empty()) {
      return atom(node.atom, scope);
    }
    const std::string& head = node.items.at(0).atom;
    const auto item = [&](std::size_t i) -> const Node& { return node.items.at(i); };
    if (head == "define" || head == "setq") {
      if (head == "setq" && !globals_.contains(item(1).atom)) {
        throw std::runtime_error("not defined: " + item(1).atom);
      }
      return globals_[item(1).atom] = run(item(2), scope);
    }
    if (head == "var") {
      return scope[item(1).atom] = run(item(2), scope);
    }
    if (head == "defun") {
      functions_[item(1).atom] = node;
      return 0.0F;
    }
    if (head == "progn") {
      float last = 0.0F;
      for (std::size_t i = 1; i < node.items.size(); ++i) {
        last = run(item(i), scope);
      }
      return last;
    }
    if (head == "if") {
      return run(run(item(1), scope) != 0.0F ? item(2) : item(3), scope);
    }
    if (head == "conf-set") {
      return settings[item(1).atom] = run(item(2), scope);
    }
    if (head == "conf-get") {
      return settings.at(item(1).atom);
    }
    return call(head, node, scope);
  }

  float call(const std::string& head, const Node& node, Scope& scope) {
    std::vector<float> with;
    for (std::size_t i = 1; i < node.items.size(); ++i) {
      with.push_back(run(node.items[i], scope));
    }
    if (const auto function = functions_.find(head); function != functions_.end()) {
      Scope inner;
      const std::vector<Node>& names = function->second.items.at(2).items;
      for (std::size_t i = 0; i < names.size(); ++i) {
        inner[names[i].atom] = with.at(i);
      }
      return run(function->second.items.at(3), inner);
    }
    if (const auto extension = extensions.find(head); extension != extensions.end()) {
      return extension->second(with);
    }
    if (head == "sqrt" || head == "exp") {
      return head == "sqrt" ? std::sqrt(with.at(0)) : std::exp(with.at(0));
    }
    const float a = with.at(0);
    const float b = with.at(1);
    if (head == "<" || head == ">") {
      return (head == "<" ? a < b : a > b) ? 1.0F : 0.0F;
    }
    if (head == "=") {
      return a == b ? 1.0F : 0.0F;
    }
    switch (head.size() == 1 ? head[0] : ' ') {
      case '+':
        return a + b;
      case '-':
        return a - b;
      case '*':
        return a * b;
      case '/':
        return a / b;
      default:
        throw std::runtime_error("not known: " + head);
    }
  }

  std::string line_;
  Scope globals_;
  std::map<std::string, Node> functions_;
  Node loop_;
};

}  // namespace heatsoak::derate
