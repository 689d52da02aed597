#include "estimation/linearised_run.h"

#include "base/diagnostic.h"
#include "estimation/findings.h"
#include "estimation/spans.h"
#include "thermal/tangent_run.h"

namespace heatsoak::estimation {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

class Recorder {
 public:
  /// `path_C` is null if the network runs freely.
  Recorder(LinearisedRun& out, const MeasuredRun& run, Eigen::Index wanted, const Eigen::MatrixXd* path_C)
      : out_(out),
        run_(run),
        path_C_(path_C),
        by_start_(Eigen::MatrixXd::Identity(out.states, out.states)),
        next_by_start_(by_start_),
        by_parameter_(Eigen::MatrixXd::Zero(out.states, wanted)),
        next_by_parameter_(by_parameter_) {
    const Eigen::Index samples = run.samples();
    const Eigen::Index rows = samples * out.sensors();
    out.state_C.resize(out.states, samples);
    out.sensor_C.resize(samples, out.sensors());
    out.residual_K.resize(rows);
    off_K_ = next_off_K_ = Eigen::VectorXd::Zero(out.states);
    out.by_start.resize(rows, out.states);
    out.by_parameter.resize(rows, wanted);
    out.transition.resize(static_cast<std::size_t>((samples - 1) * out.states * out.states));
    out.injection.resize(static_cast<std::size_t>((samples - 1) * out.states * out.fluxes));
    out.duration_s.resize(static_cast<std::size_t>(samples - 1));
  }

  void note(Eigen::Index sample) {
    for (Eigen::Index sensor = 0; sensor < out_.sensors(); ++sensor) {
      const Eigen::Index row = sample * out_.sensors() + sensor;
      const int node = out_.sensor_node[static_cast<std::size_t>(sensor)];
      out_.sensor_C(sample, sensor) = out_.state_C(node, sample) + off_K_[node];
      out_.residual_K[row] = run_.measured_C(sample, sensor) - out_.sensor_C(sample, sensor);
      out_.by_start.row(row) = by_start_.row(node);
      out_.by_parameter.row(row) = by_parameter_.row(node);
    }
  }

  void advance(Eigen::Index interval, const thermal::NetworkStep& step) {
    const auto place = static_cast<std::size_t>(interval);
    const Eigen::Index x = out_.states;
    const Eigen::Index wanted = by_parameter_.cols();
    Eigen::Map<RowMajor>(out_.transition.data() + interval * x * x, x, x) = step.by_start;
    Eigen::Map<RowMajor>(out_.injection.data() + interval * x * out_.fluxes, x, out_.fluxes) = step.by_parameter.rightCols(out_.fluxes);
    out_.duration_s[place] = run_.time_s[place + 1] - run_.time_s[place];
    next_off_K_.noalias() = step.by_start.lazyProduct(off_K_);
    if (path_C_) {
      out_.state_C.col(interval + 1) = path_C_->col(interval + 1);
      next_off_K_ += step.state_C - path_C_->col(interval + 1);
    } else {
      out_.state_C.col(interval + 1) = step.state_C;
    }
    off_K_.swap(next_off_K_);
    next_by_start_.noalias() = step.by_start.lazyProduct(by_start_);
    by_start_.swap(next_by_start_);
    next_by_parameter_.noalias() = step.by_start.lazyProduct(by_parameter_);
    next_by_parameter_ += step.by_parameter.leftCols(wanted);
    by_parameter_.swap(next_by_parameter_);
  }

 private:
  LinearisedRun& out_;
  const MeasuredRun& run_;
  const Eigen::MatrixXd* path_C_;
  Eigen::VectorXd off_K_, next_off_K_;  ///< solution of the linear equations minus the path
  Eigen::MatrixXd by_start_, next_by_start_;
  Eigen::MatrixXd by_parameter_, next_by_parameter_;
};

}  // namespace

void add_fault(const motor::SensorFault& fault, Eigen::Index sensor, const MeasuredRun& run, LinearisedRun& out) {
  const motor::SensorLaw& law = fault.type->law;
  law.apply(run.time_s, fault.size, false, as_span(out.sensor_C.col(sensor)));
  const auto rows = Eigen::seq(sensor, out.residual_K.size() - 1, out.sensors());
  out.residual_K(rows) = run.measured_C.col(sensor) - out.sensor_C.col(sensor);
  for (Columns* const columns : {&out.by_start, &out.by_parameter}) {
    for (Eigen::Index column = 0; column < columns->cols(); ++column) {
      Eigen::VectorXd change = (*columns)(rows, column);
      law.apply(run.time_s, fault.size, true, as_span(change));
      (*columns)(rows, column) = change;
    }
  }
}

namespace {

LinearisedRun linearise_unnamed(const thermal::Network& network, std::span<const double> parameters, std::span<const int> wanted,
                                std::span<const int> flux_nodes, std::span<const double> start_C, const MeasuredRun& run,
                                const Eigen::MatrixXd* path_C) {
  LinearisedRun out;
  out.states = network.state_count();
  out.fluxes = static_cast<Eigen::Index>(flux_nodes.size());
  for (const Sensor& sensor : run.sensors) {
    out.sensor_node.push_back(network.node(sensor.node));
  }
  Recorder recorder(out, run, static_cast<Eigen::Index>(wanted.size()), path_C);
  out.state_C.col(0) = Eigen::Map<const Eigen::VectorXd>(start_C.data(), out.states);
  recorder.note(0);
  thermal::TangentRun tangent(network, parameters, wanted, flux_nodes);
  Eigen::MatrixXd others_C;
  auto unknown = run.unknown_inputs.begin();
  for (Eigen::Index k = 0; k + 1 < run.samples(); ++k) {
    const auto place = static_cast<std::size_t>(k);
    const std::span<const double> start(out.state_C.col(k).data(), static_cast<std::size_t>(out.states));
    const double duration_s = run.time_s[place + 1] - run.time_s[place];
    others_C.resize(out.states, 0);
    for (; unknown != run.unknown_inputs.end() && unknown->interval == k; ++unknown) {
      others_C.conservativeResize(Eigen::NoChange, others_C.cols() + 1);
      others_C.rightCols<1>() = tangent.over(start, duration_s, unknown->other).state_C;
    }
    const thermal::NetworkStep& step = tangent.over(start, duration_s, run.at[place]);
    recorder.advance(k, step);
    if (others_C.cols() > 0) {
      others_C.colwise() -= step.state_C;
      out.state_uncertainties.push_back({k, others_C * others_C.transpose()});
    }
    recorder.note(k + 1);
  }
  for (Eigen::Index sensor = 0; sensor < out.sensors(); ++sensor) {
    for (const motor::SensorFault& fault : run.sensors[static_cast<std::size_t>(sensor)].faults) {
      add_fault(fault, sensor, run, out);
    }
  }
  return out;
}

/// Calls `make`; throws RunNotSimulated for any Failure.
template <class Make>
LinearisedRun named(const MeasuredRun& run, const Make& make) {
  try {
    return make();
  } catch (const base::Failure& failure) {
    throw RunNotSimulated(run.name, failure);
  }
}

}  // namespace

LinearisedRun linearise(const thermal::Network& network, std::span<const double> parameters, std::span<const int> wanted,
                        std::span<const int> flux_nodes, std::span<const double> start_C, const MeasuredRun& run) {
  return named(run, [&] { return linearise_unnamed(network, parameters, wanted, flux_nodes, start_C, run, nullptr); });
}

LinearisedRun linearise_along(const thermal::Network& network, std::span<const double> parameters, std::span<const int> wanted,
                              std::span<const int> flux_nodes, const Eigen::MatrixXd& path_C, const MeasuredRun& run) {
  const Eigen::VectorXd start_C = path_C.col(0);
  return named(run, [&] {
    return linearise_unnamed(network, parameters, wanted, flux_nodes, {start_C.data(), static_cast<std::size_t>(start_C.size())}, run,
                             &path_C);
  });
}

}  // namespace heatsoak::estimation
