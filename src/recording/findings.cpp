#include "recording/findings.h"

#include <string_view>

namespace heatsoak::recording {
namespace {

template <class Kind>
std::vector<std::string_view> channels_in(const Kind& of) {
  std::vector<std::string_view> channels;
  if constexpr (requires { of.channel; }) {
    channels.push_back(of.channel);
  }
  if constexpr (requires { of.temperature; }) {
    channels.push_back(of.temperature);
  }
  if constexpr (requires { of.heat_input; }) {
    channels.push_back(of.heat_input);
  }
  return channels;
}

}  // namespace

bool have_one_subject(const Suspicion& a, const Suspicion& b) {
  const auto channels = [](const Suspicion& of) { return std::visit([](const auto& each) { return channels_in(each); }, of); };
  return a.index() == b.index() && channels(a) == channels(b);
}

}  // namespace heatsoak::recording
