#pragma once
// Thermal network of any number of bodies, integrated with the classical Runge-Kutta method of fourth order.
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace heatsoak::suite {

/// Inputs during one integration step.
struct Instant {
  double time_s = 0.0;
  double current_A = 0.0;
  double speed_rad_per_s = 0.0;
  double bus_V = 0.0;
  double modulation_ratio = 0.0;
  double ambient_C = 25.0;
  double vehicle_speed_m_per_s = 0.0;
  double fan_ratio = 0.0;
  double neighbour_C = 25.0;
};

/// Books the heat of one instant. A flow between bodies leaves one and enters the other; heat to the air is lost.
class HeatBook {
 public:
  explicit HeatBook(std::span<double> heat_W) : heat_W_(heat_W) {}
  void source(std::size_t body, double power_W) {
    heat_W_[body] += power_W;
    in_W_ += power_W;
  }
  void flow(std::size_t from, std::size_t to, double power_W) {
    heat_W_[from] -= power_W;
    heat_W_[to] += power_W;
  }
  void to_air(std::size_t body, double power_W) {
    heat_W_[body] -= power_W;
    lost_W_ += power_W;
  }
  double in_W() const { return in_W_; }
  double lost_W() const { return lost_W_; }

 private:
  std::span<double> heat_W_;
  double in_W_ = 0.0;
  double lost_W_ = 0.0;
};

using Law = std::function<void(const Instant&, std::span<const double> temperature_C, HeatBook&)>;

struct Body {
  std::string name;
  double capacity_J_per_K = 1.0;
};

struct Link {
  std::size_t first = 0;
  std::size_t second = 0;
  double conductance_W_per_K = 0.0;
};

struct AirLink {
  std::size_t body = 0;
  double conductance_W_per_K = 0.0;
};

struct Network {
  std::vector<Body> bodies;
  std::vector<Link> links;
  std::vector<AirLink> air_links;
  std::vector<Law> laws;
};

struct State {
  std::vector<double> temperature_C;
  double heat_in_J = 0.0;
  double heat_lost_J = 0.0;
};

/// Advances the state by one step with constant inputs.
void advance(const Network& network, const Instant& instant, double step_s, State& state);

}  // namespace heatsoak::suite
