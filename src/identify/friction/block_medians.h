// A log condensed into medians of a few rows, with the noise that they have.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "identify/friction/friction_log.h"

namespace heatsoak {

/// Signals stand in the order wheel speeds, voltages.
struct BlockMedians {
  std::vector<std::size_t> first_row;  ///< per block
  std::size_t rows_per_block = 0;
  std::vector<double> begin_s;
  std::vector<double> duration_s;
  Eigen::MatrixXd raw;         ///< signals × blocks; NaN where fewer than three rows have a value
  Eigen::MatrixXd values;      ///< the same with the odd block out replaced: median of three neighbours
  Eigen::VectorXd resolution;  ///< per signal: of the sensor; 0 where none is seen
  Eigen::VectorXd top;         ///< per signal: 95 % of the blocks' sizes lie below
};

/// Rows [begin, end) of the log.
BlockMedians block_medians(const FrictionLog& log, int wheel_count, std::size_t begin, std::size_t end);

/// Standard deviation of the blocks [begin, end) of a signal by their second differences, in which a steady rise does not
/// count as noise; at least half the resolution.
double block_deviation(const BlockMedians& blocks, Eigen::Index signal, Eigen::Index begin, Eigen::Index end);

}  // namespace heatsoak
