#include <algorithm>
#include <array>
#include <vector>

#include "thermal/evaluation.h"
#include "thermal/linearised.h"

namespace heatsoak::thermal {
namespace {

/// Scratch memory kept between calls: clearing unused derivatives would cost more than evaluating the laws.
struct Workspace {
  std::vector<Tangent> parameter;
  std::array<Tangent, Network::kMostNodes> temperature_C;  ///< temperatures of all nodes, for the drive stage
  std::array<Tangent, Network::kMostRoles> role_C;         ///< temperatures of the roles of the effect in turn
  std::array<Tangent, Network::kMostRoles> heat_W;         ///< heat that the effect books into its roles
  OperatingPoint<Tangent> seen;
};

/// Directions of the derivatives of the copper loss behind the drive stage.
enum CopperDirection { by_resistance, by_coefficient, by_winding };

void seed(Tangent& number, int direction) {
  number.v.setZero();
  if (direction >= 0 && direction < kDirections) {
    number.v[direction] = 1.0;
  }
}

/// Sums the heat of the effects with its derivatives. Each effect is differentiated with respect to its own inputs, kDirections at a time:
/// first the temperatures of its roles, then its parameters, then the copper loss.
class Linearisation {
 public:
  Linearisation(int states, const DriveStage::Places* drive, Workspace& workspace, Linearised& out)
      : states_(states), drive_(drive), workspace_(workspace), out_(out) {
    out.rate_K_per_s.setZero(states);
    out.by_state.setZero(states, states);
    out.by_parameter.setZero(states, static_cast<Eigen::Index>(workspace.parameter.size()));
  }

  /// The copper loss in `at` has the derivatives of the drive stage.
  void add(const EffectInPlace& effect, OperatingPoint<Tangent>& at) {
    const Tangent copper_loss_W = at.copper_loss_W;
    const int roles = static_cast<int>(effect.node_index.size());
    const int directions = roles + static_cast<int>(effect.parameter_index.size()) + 1;
    for (int role = 0; role < roles; ++role) {
      workspace_.role_C[role].a = workspace_.temperature_C[effect.node_index[role]].a;
    }
    for (int first = 0; first < directions; first += kDirections) {
      book_from(effect, at, first);
      for (int role = 0; role < roles; ++role) {
        const int node = effect.node_index[role];
        if (node >= states_) {
          continue;
        }
        const Tangent& heat_W = workspace_.heat_W[role];
        if (first == 0) {
          out_.rate_K_per_s[node] += heat_W.a;
        }
        for (int d = first; d < std::min(first + kDirections, directions); ++d) {
          add_derivative(effect, copper_loss_W, node, d, heat_W.v[d - first]);
        }
      }
    }
    at.copper_loss_W = copper_loss_W;
  }

  /// Divides heat in W by the heat capacities, so that rates and derivatives are per second.
  void divide_by(std::span<const int> capacity_index) {
    std::array<double, Network::kMostNodes> per_capacity_K_per_J{};
    for (int node = 0; node < states_; ++node) {
      per_capacity_K_per_J[node] = 1.0 / workspace_.parameter[capacity_index[node]].a;
      out_.rate_K_per_s[node] *= per_capacity_K_per_J[node];
    }
    // Column by column, as they lie in memory.
    for (Eigen::MatrixXd* const matrix : {&out_.by_state, &out_.by_parameter}) {
      double* entry = matrix->data();
      for (Eigen::Index column = 0; column < matrix->cols(); ++column) {
        for (int node = 0; node < states_; ++node) {
          *entry++ *= per_capacity_K_per_J[node];
        }
      }
    }
    for (int node = 0; node < states_; ++node) {
      out_.by_parameter(node, capacity_index[node]) -= out_.rate_K_per_s[node] * per_capacity_K_per_J[node];
    }
  }

 private:
  /// Books the heat of each role with its derivatives in kDirections directions, starting at direction `first`. A node that plays two roles
  /// has one direction for each.
  void book_from(const EffectInPlace& effect, OperatingPoint<Tangent>& at, int first) {
    static constexpr std::array<int, Network::kMostRoles> kRoles{0, 1, 2, 3};
    int direction = -first;
    for (std::size_t role = 0; role < effect.node_index.size(); ++role) {
      seed(workspace_.role_C[role], direction++);
      workspace_.heat_W[role] = Tangent(0.0);
    }
    for (const int parameter : effect.parameter_index) {
      seed(workspace_.parameter[parameter], direction++);
    }
    seed(at.copper_loss_W, direction);
    HeatBook<Tangent> heat(workspace_.heat_W.data(), kRoles.data());
    book<Tangent>(effect, at, workspace_.parameter.data(), workspace_.role_C.data(), kRoles.data(), heat);
  }

  void add_derivative(const EffectInPlace& effect, const Tangent& copper_loss_W, int node, int direction, double slope) {
    const int roles = static_cast<int>(effect.node_index.size());
    const int count = static_cast<int>(effect.parameter_index.size());
    if (slope == 0.0) {
      return;
    }
    if (direction < roles) {
      if (const int from = effect.node_index[direction]; from < states_) {
        out_.by_state(node, from) += slope;
      }
    } else if (direction < roles + count) {
      out_.by_parameter(node, effect.parameter_index[direction - roles]) += slope;
    } else if (drive_) {
      if (drive_->winding < states_) {
        out_.by_state(node, drive_->winding) += slope * copper_loss_W.v[by_winding];
      }
      out_.by_parameter(node, drive_->resistance) += slope * copper_loss_W.v[by_resistance];
      out_.by_parameter(node, drive_->coefficient) += slope * copper_loss_W.v[by_coefficient];
    }
  }

  int states_;
  const DriveStage::Places* drive_;  ///< null without a drive stage
  Workspace& workspace_;
  Linearised& out_;
};

}  // namespace

void Network::linearise(const OperatingPoint<double>& at, std::span<const double> parameters, std::span<const double> state_C,
                        Linearised& out) const {
  static thread_local Workspace workspace;
  auto& [parameter, temperature_C, role_C, heat_W, seen] = workspace;
  parameter.resize(parameters.size());
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    parameter[i].a = parameters[i];
  }
  for (std::size_t node = 0; node < node_names_.size(); ++node) {
    temperature_C[node].a = state_C[node];
  }
  temperature_C[node_names_.size()].a = at.ambient_C;
  // Only the copper loss ever carries derivatives here; they are set again for every law.
  convert_point([](Tangent& to, const double& from) { to.a = from; }, seen, at);
  seen.copper_loss_W.v.setZero();
  const DriveStage::Places* const drive = drive_ ? &drive_->places() : nullptr;
  if (drive) {
    seed(parameter[drive->resistance], by_resistance);
    seed(parameter[drive->coefficient], by_coefficient);
    seed(temperature_C[drive->winding], by_winding);
  }
  Linearisation linearisation(state_count(), drive, workspace, out);
  evaluate<Tangent>(seen, parameter.data(), temperature_C.data(),
                    [&](const EffectInPlace& effect, OperatingPoint<Tangent>& driven) { linearisation.add(effect, driven); });
  linearisation.divide_by(capacity_index_);
}

}  // namespace heatsoak::thermal
