#include "estimation/moved_sensor.h"

#include <Eigen/Dense>
#include <cmath>

#include "base/diagnostic.h"
#include "estimation/model_along_run.h"
#include "estimation/open_loop.h"

namespace heatsoak::estimation {
namespace {

enum Move : Eigen::Index { to_other, to_ambient, offset, move_count };

constexpr int kSteps = 5;
/// Prior standard deviations of a start temperature and of the shares and the offset, which keep the equations regular.
constexpr double kStart_sd_K = 20.0;
constexpr double kShare_sd = 1.0;
constexpr double kOffset_sd_K = 20.0;

class MoveFit {
 public:
  MoveFit(const std::vector<MeasuredRun>& parts, const std::vector<LinearisedRun>& paths, std::size_t sensor)
      : parts_(parts), paths_(paths), moved_(static_cast<Eigen::Index>(sensor)) {
    Eigen::Index starts = 0;
    for (const LinearisedRun& path : paths) {
      starts += path.states;
    }
    precision_ = Eigen::VectorXd::Constant(move_count + starts, 1.0 / (kStart_sd_K * kStart_sd_K));
    precision_[to_other] = precision_[to_ambient] = 1.0 / (kShare_sd * kShare_sd);
    precision_[offset] = 1.0 / (kOffset_sd_K * kOffset_sd_K);
    solution_ = Eigen::VectorXd::Zero(precision_.size());
  }

  MovedSensor result() {
    for (int step = 0; step < kSteps; ++step) {
      add_up();
      square_.diagonal() += precision_;
      solution_ += square_.ldlt().solve(right_ - precision_.cwiseProduct(solution_));
    }
    add_up();
    double mean_K2 = 0.0;
    for (Eigen::Index s = 0; s < squares_K2_.size(); ++s) {
      mean_K2 += squares_K2_[s] / std::max(1.0, samples_[s]) / static_cast<double>(squares_K2_.size());
    }
    return {parts_.front().sensors[static_cast<std::size_t>(moved_)].signal, solution_[to_other], solution_[to_ambient], solution_[offset],
            std::sqrt(mean_K2)};
  }

 private:
  /// Adds up the normal equations and the squared residuals at the present solution.
  void add_up() {
    square_.setZero(solution_.size(), solution_.size());
    right_.setZero(solution_.size());
    squares_K2_.setZero(paths_.front().sensors());
    samples_.setZero(paths_.front().sensors());
    Eigen::Index start = move_count;
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      for (Eigen::Index k = 0; k < paths_[p].samples(); ++k) {
        add_sample(parts_[p], paths_[p], k, start);
      }
      start += paths_[p].states;
    }
  }

  void add_sample(const MeasuredRun& run, const LinearisedRun& path, Eigen::Index k, Eigen::Index start) {
    const Eigen::Index sensors = path.sensors();
    const Eigen::MatrixXd by_start = path.by_start.middleRows(k * sensors, sensors);
    const Eigen::VectorXd there_C = path.sensor_C.row(k).transpose() + by_start * solution_.segment(start, path.states);
    const double ambient_C = run.at[static_cast<std::size_t>(std::min(k, path.samples() - 2))].ambient_C;
    for (Eigen::Index s = 0; s < sensors; ++s) {
      const double measured_C = path.residual_K[k * sensors + s] + path.sensor_C(k, s);
      if (std::isnan(measured_C)) {
        continue;
      }
      Eigen::VectorXd slope = Eigen::VectorXd::Zero(solution_.size());
      slope.segment(start, path.states) = by_start.row(s);
      double predicted_C = there_C[s];
      if (s == moved_) {
        const Eigen::Index other = sensors > 1 ? (s == 0 ? 1 : 0) : s;
        slope[to_other] = there_C[other] - there_C[s];
        slope[to_ambient] = ambient_C - there_C[s];
        slope[offset] = 1.0;
        predicted_C += slope.head(move_count).dot(solution_.head(move_count));
        slope.segment(start, path.states) +=
            solution_[to_other] * (by_start.row(other) - by_start.row(s)).transpose() - solution_[to_ambient] * by_start.row(s).transpose();
      }
      const double residual_K = measured_C - predicted_C;
      square_ += slope * slope.transpose();
      right_ += slope * residual_K;
      squares_K2_[s] += residual_K * residual_K;
      samples_[s] += 1.0;
    }
  }

  const std::vector<MeasuredRun>& parts_;
  const std::vector<LinearisedRun>& paths_;
  Eigen::Index moved_;
  Eigen::VectorXd precision_, solution_, right_, squares_K2_, samples_;
  Eigen::MatrixXd square_;
};

}  // namespace

std::optional<MovedSensor> moved_sensor(const Model& model, const std::vector<MeasuredRun>& parts) {
  std::vector<LinearisedRun> paths;
  for (const MeasuredRun& part : parts) {
    const RunStart start = start_of(model.network, part);
    try {
      paths.push_back(linearise(model, {start.state_C.data(), static_cast<std::size_t>(start.state_C.size())}, part));
    } catch (const base::Failure&) {
      return std::nullopt;
    }
  }
  std::optional<MovedSensor> best;
  for (std::size_t sensor = 0; sensor < parts.front().sensors.size(); ++sensor) {
    const MovedSensor found = MoveFit(parts, paths, sensor).result();
    if (std::isfinite(found.rmse_K) && (!best || found.rmse_K < best->rmse_K)) {
      best = found;
    }
  }
  return best;
}

}  // namespace heatsoak::estimation
