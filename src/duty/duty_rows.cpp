#include "duty/duty_rows.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <string>
#include <utility>

namespace heatsoak::duty {

DutyRows::DutyRows(std::size_t wheel_count, DutyKind kind, double every_s, Put put)
    : kind_(kind), every_s_(every_s), put_(std::move(put)), means_(wheel_count) {
  std::string header = "time_s";
  for (std::size_t i = 1; i <= wheel_count; ++i) {
    header += kind == DutyKind::torque ? fmt::format(",torque_{0}_Nm,speed_{0}_rad_per_s", i)
                                       : fmt::format(",current_{0}_A,speed_{0}_rad_per_s", i);
  }
  put_(header + "\n");
}

void DutyRows::add(double duration_s, std::span<const double> torque_Nm, std::span<const double> speed_rad_per_s) {
  for (std::size_t i = 0; i < means_.size(); ++i) {
    means_[i].add(duration_s, torque_Nm[i], speed_rad_per_s[i]);
  }
  if (means_.front().time_s() >= every_s_ * (1.0 - 1e-9)) {
    close();
  }
}

void DutyRows::close() {
  row_.clear();
  for (LoadMeans& each : means_) {
    row_.push_back(each.close());
  }
  add(row_);
}

void DutyRows::add(std::span<const LoadBin> bins) {
  std::string text = fmt::format("{:.10g}", time_s_);
  for (const LoadBin& bin : bins) {
    const double load = kind_ == DutyKind::torque ? std::copysign(bin.torque_rms_Nm, bin.torque_mean_Nm)
                                                  : std::copysign(bin.current_rms_A, bin.current_mean_A);
    fmt::format_to(std::back_inserter(text), ",{:.5g},{:.5g}", load, std::copysign(bin.speed_mean_rad_per_s, bin.velocity_mean_rad_per_s));
  }
  put_(text + "\n");
  time_s_ += bins.front().duration_s;
}

void DutyRows::finish() {
  if (means_.front().time_s() > 0.0) {
    close();
  }
  std::string text = fmt::format("{:.10g}", time_s_);
  for (std::size_t i = 0; i < means_.size(); ++i) {
    text += ",0,0";
  }
  put_(text + "\n");
}

}  // namespace heatsoak::duty
