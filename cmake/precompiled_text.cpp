#include "precompiled.h"

template void fmt::detail::vformat_to<char>(fmt::detail::buffer<char>&, fmt::string_view, fmt::format_args, fmt::detail::locale_ref);
template class nlohmann::basic_json<>;
template class nlohmann::basic_json<nlohmann::ordered_map>;
template class nlohmann::detail::serializer<nlohmann::json>;
template class nlohmann::detail::serializer<nlohmann::ordered_json>;

#if defined(__GLIBCXX__) && _GLIBCXX_RELEASE == 12
template class std::basic_regex<char>;
template class std::__detail::_Scanner<char>;
template class std::__detail::_StateSeq<std::regex_traits<char>>;
template class std::__detail::_Compiler<std::regex_traits<char>>;
template struct std::__detail::_BracketMatcher<std::regex_traits<char>, false, false>;
template struct std::__detail::_BracketMatcher<std::regex_traits<char>, false, true>;
template struct std::__detail::_BracketMatcher<std::regex_traits<char>, true, false>;
template struct std::__detail::_BracketMatcher<std::regex_traits<char>, true, true>;
template bool std::__detail::__regex_algo_impl(std::string::const_iterator, std::string::const_iterator, std::smatch&, const std::regex&,
                                               std::regex_constants::match_flag_type, std::__detail::_RegexExecutorPolicy, bool);
template class std::regex_iterator<std::string::const_iterator>;
#endif
