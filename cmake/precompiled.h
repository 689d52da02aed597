// Library headers that most files include, and declarations of templates that precompiled.cpp instantiates once. The compiler includes this
// header before every file; no file includes it explicitly. Everything also compiles without it, in twice the time.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <regex>
#include <set>
#include <span>
#include <string>
#include <vector>

extern template class Eigen::LLT<Eigen::MatrixXd>;
extern template Eigen::LLT<Eigen::MatrixXd>& Eigen::LLT<Eigen::MatrixXd>::compute(const Eigen::EigenBase<Eigen::MatrixXd>&);
extern template class Eigen::LDLT<Eigen::MatrixXd>;
extern template Eigen::LDLT<Eigen::MatrixXd>& Eigen::LDLT<Eigen::MatrixXd>::compute(const Eigen::EigenBase<Eigen::MatrixXd>&);
extern template class Eigen::PartialPivLU<Eigen::MatrixXd>;
extern template class Eigen::HouseholderQR<Eigen::MatrixXd>;
extern template class Eigen::ColPivHouseholderQR<Eigen::MatrixXd>;
extern template class Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>;
extern template class Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;
extern template Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>& Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>::compute(
    const Eigen::EigenBase<Eigen::MatrixXd>&, int);

// Products, triangular solutions and LU decompositions of Eigen's packets of two doubles, which x86-64 without options has.
#ifdef EIGEN_VECTORIZE_SSE2
namespace Eigen::internal {
using Rows = const_blas_data_mapper<double, Index, RowMajor>;
using Columns = const_blas_data_mapper<double, Index, ColMajor>;
extern template struct general_matrix_vector_product<Index, double, Rows, RowMajor, false, double, Columns, false>;
extern template struct general_matrix_vector_product<Index, double, Columns, ColMajor, false, double, Rows, false>;
extern template struct gebp_kernel<double, double, Index, blas_data_mapper<double, Index, ColMajor>, 4, 4, false, false>;
extern template struct general_matrix_matrix_product<Index, double, ColMajor, false, double, ColMajor, false, ColMajor, 1>;
extern template struct general_matrix_matrix_product<Index, double, RowMajor, false, double, ColMajor, false, ColMajor, 1>;
extern template struct general_matrix_matrix_product<Index, double, ColMajor, false, double, RowMajor, false, ColMajor, 1>;
extern template struct triangular_solve_matrix<double, Index, OnTheLeft, UnitLower, false, ColMajor, ColMajor, 1>;
extern template struct triangular_solve_matrix<double, Index, OnTheLeft, Upper, false, ColMajor, ColMajor, 1>;
extern template struct partial_lu_impl<double, ColMajor, int>;
}  // namespace Eigen::internal
#endif

extern template void fmt::detail::vformat_to<char>(fmt::detail::buffer<char>&, fmt::string_view, fmt::format_args, fmt::detail::locale_ref);

extern template class nlohmann::basic_json<>;
extern template class nlohmann::basic_json<nlohmann::ordered_map>;
extern template class nlohmann::detail::serializer<nlohmann::json>;
extern template class nlohmann::detail::serializer<nlohmann::ordered_json>;

// Members of std::regex that are not inline take seconds to compile in every file that uses one. The internal names are those of GCC 12.
#if defined(__GLIBCXX__) && _GLIBCXX_RELEASE == 12
extern template class std::basic_regex<char>;
extern template class std::__detail::_Scanner<char>;
extern template class std::__detail::_StateSeq<std::regex_traits<char>>;
extern template class std::__detail::_Compiler<std::regex_traits<char>>;
extern template struct std::__detail::_BracketMatcher<std::regex_traits<char>, false, false>;
extern template struct std::__detail::_BracketMatcher<std::regex_traits<char>, false, true>;
extern template struct std::__detail::_BracketMatcher<std::regex_traits<char>, true, false>;
extern template struct std::__detail::_BracketMatcher<std::regex_traits<char>, true, true>;
extern template bool std::__detail::__regex_algo_impl(std::string::const_iterator, std::string::const_iterator, std::smatch&,
                                                      const std::regex&, std::regex_constants::match_flag_type,
                                                      std::__detail::_RegexExecutorPolicy, bool);
extern template class std::regex_iterator<std::string::const_iterator>;
#endif
