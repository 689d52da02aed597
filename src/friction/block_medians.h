// Condenses a log into medians of blocks of rows, and estimates their noise.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "friction/friction_log.h"

namespace heatsoak::friction {

/// Medians of blocks of rows. The signals are in the order wheel speeds, voltages; signals without a column are omitted.
struct BlockMedians {
  std::vector<std::size_t> first_row;  ///< per block
  std::size_t rows_per_block = 0;
  std::vector<double> begin_s;
  std::vector<double> duration_s;
  Eigen::MatrixXd raw;         ///< signals × blocks; NaN if too few rows of the block have a value
  Eigen::MatrixXd values;      ///< running median of three blocks of `raw`, against single outliers
  Eigen::VectorXd resolution;  ///< per signal: resolution of the sensor; 0 if no quantisation is visible
  Eigen::VectorXd top;         ///< per signal: 95th percentile of the blocks' magnitudes
};

/// Condenses rows [begin, end) of the log. An incomplete last block is dropped.
BlockMedians block_medians(const FrictionLog& log, int wheel_count, std::size_t begin, std::size_t end);

/// Returns the standard deviation of the blocks [begin, end) of a signal, from second differences, so that a constant slope does not count
/// as noise. At least half of the resolution.
double block_deviation(const BlockMedians& blocks, Eigen::Index signal, Eigen::Index begin, Eigen::Index end);

}  // namespace heatsoak::friction
