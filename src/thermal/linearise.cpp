#include <algorithm>
#include <array>
#include <optional>

#include "thermal/law.h"
#include "thermal/linearised.h"
#include "thermal/network.h"

namespace heatsoak::thermal {
namespace {

constexpr int kMostRoles = Network::kMostRoles;
constexpr int kMostParameters = Network::kMostParameters;

/// Derivatives of the copper loss at this moment, for laws that depend on it.
struct CopperGradient {
  DriveStage::Places places;
  double by_winding_W_per_K = 0.0;
  double by_resistance_W_per_ohm = 0.0;
  double by_coefficient_W_K = 0.0;
};

/// Scratch memory kept between calls: clearing unused derivatives would cost more than evaluating the laws.
struct Workspace {
  std::array<Tangent, kMostRoles> temperature_C;
  std::array<Tangent, kMostParameters> parameter;
  std::array<Tangent, kMostRoles> heat_W;
  OperatingPoint<Tangent> seen;
};

/// Evaluates one effect with derivatives with respect to its temperatures, its parameters and the copper loss, kDirections at a time.
class LocalLaw {
 public:
  LocalLaw(const EffectInPlace& effect, std::span<const double> parameters, const double* temperature_C, Workspace& workspace)
      : temperature_C_(workspace.temperature_C),
        parameter_(workspace.parameter),
        heat_W_(workspace.heat_W),
        effect_(effect),
        roles_(static_cast<int>(effect.node_index.size())),
        count_(static_cast<int>(effect.parameter_index.size())) {
    for (int role = 0; role < roles_; ++role) {
      temperature_C_[role].a = temperature_C[effect.node_index[role]];
    }
    for (int i = 0; i < count_; ++i) {
      parameter_[i].a = parameters[effect.parameter_index[i]];
    }
  }

  /// Number of derivative directions, ordered: node roles, parameters, copper loss.
  [[nodiscard]] int direction_count() const { return roles_ + count_ + 1; }

  /// Computes the heat per role and its derivatives in kDirections directions, starting at direction `first`.
  void book(OperatingPoint<Tangent>& at, int first) {
    for (int role = 0; role < roles_; ++role) {
      seed(temperature_C_[role], role - first);
      heat_W_[role] = Tangent(0.0);
    }
    for (int i = 0; i < count_; ++i) {
      seed(parameter_[i], roles_ + i - first);
    }
    seed(at.copper_loss_W, roles_ + count_ - first);
    static constexpr std::array<int, kMostParameters> kOwn{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    const Situation<Tangent> situation(at, parameter_.data(), kOwn.data(), temperature_C_.data(), kOwn.data());
    HeatBook<Tangent> heat(heat_W_.data(), kOwn.data());
    effect_.type->laws->tangent(situation, heat);
  }
  [[nodiscard]] const Tangent& heat_W(int role) const { return heat_W_[role]; }

 private:
  static void seed(Tangent& number, int direction) {
    number.v.setZero();
    if (direction >= 0 && direction < kDirections) {
      number.v[direction] = 1.0;
    }
  }

  std::array<Tangent, kMostRoles>& temperature_C_;
  std::array<Tangent, kMostParameters>& parameter_;
  std::array<Tangent, kMostRoles>& heat_W_;
  const EffectInPlace& effect_;
  int roles_;
  int count_;
};

class Linearisation {
 public:
  Linearisation(std::span<const double> parameters, const double* temperature_C, int states, Workspace& workspace, Linearised& out)
      : workspace_(workspace), parameters_(parameters), temperature_C_(temperature_C), states_(states), out_(out) {
    out.rate_K_per_s.setZero(states);
    out.by_state.setZero(states, states);
    out.by_parameter.setZero(states, static_cast<Eigen::Index>(parameters.size()));
  }

  void add(const EffectInPlace& effect, OperatingPoint<Tangent>& at) {
    LocalLaw law(effect, parameters_, temperature_C_, workspace_);
    const int roles = static_cast<int>(effect.node_index.size());
    for (int first = 0; first < law.direction_count(); first += kDirections) {
      law.book(at, first);
      for (int role = 0; role < roles; ++role) {
        const int node = effect.node_index[role];
        if (node >= states_) {
          continue;
        }
        if (first == 0) {
          out_.rate_K_per_s[node] += law.heat_W(role).a;
        }
        for (int d = first; d < std::min(first + kDirections, law.direction_count()); ++d) {
          add_derivative(effect, node, d, law.heat_W(role).v[d - first]);
        }
      }
    }
  }
  void set_copper(const CopperGradient& copper) { copper_ = copper; }

  /// Divides heat in W by the heat capacities, so that rates and derivatives are per second.
  void divide_by(std::span<const int> capacity_index) {
    std::array<double, Network::kMostNodes> per_capacity_K_per_J{};
    for (int node = 0; node < states_; ++node) {
      per_capacity_K_per_J[node] = 1.0 / parameters_[capacity_index[node]];
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
  void add_derivative(const EffectInPlace& effect, int node, int direction, double slope) {
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
    } else if (copper_) {
      const DriveStage::Places& from = copper_->places;
      if (from.winding < states_) {
        out_.by_state(node, from.winding) += slope * copper_->by_winding_W_per_K;
      }
      out_.by_parameter(node, from.resistance) += slope * copper_->by_resistance_W_per_ohm;
      out_.by_parameter(node, from.coefficient) += slope * copper_->by_coefficient_W_K;
    }
  }
  Workspace& workspace_;
  std::span<const double> parameters_;
  const double* temperature_C_;
  int states_;
  Linearised& out_;
  std::optional<CopperGradient> copper_;
};

}  // namespace

void Network::linearise(const OperatingPoint<double>& at, std::span<const double> parameters, std::span<const double> state_C,
                        Linearised& out) const {
  std::array<double, kMostNodes> temperature_C{};
  std::copy_n(state_C.begin(), state_count(), temperature_C.begin());
  temperature_C[static_cast<std::size_t>(state_count())] = at.ambient_C;
  static thread_local Workspace workspace;
  OperatingPoint<Tangent>& seen = workspace.seen;
  // Only the copper loss ever carries derivatives here; they are set again for every law.
  convert_point([](Tangent& to, const double& from) { to.a = from; }, seen, at);
  seen.copper_loss_W.v.setZero();
  Linearisation linearisation(parameters, temperature_C.data(), state_count(), workspace, out);
  if (drive_) {
    const auto& [resistance, coefficient, node] = drive_->places();
    const Tangent loss_W = DriveStage::copper_loss_W(Tangent(at.current_rms_A), Tangent(parameters[resistance], 0),
                                                     Tangent(parameters[coefficient], 1), Tangent(temperature_C[node], 2));
    seen.copper_loss_W.a = loss_W.a;
    linearisation.set_copper({drive_->places(), loss_W.v[2], loss_W.v[0], loss_W.v[1]});
  }
  for (const EffectInPlace& effect : effects_) {
    linearisation.add(effect, seen);
  }
  linearisation.divide_by(capacity_index_);
}

}  // namespace heatsoak::thermal
