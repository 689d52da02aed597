// Everything that firmware gets about one motor: its observer, its table, and how far both can be trusted.
#pragma once

#include <string>
#include <vector>

#include "derate/guarantee.h"

namespace heatsoak {

struct DerateOptions {
  double hottest_ambient_C = 40.0;
  double period_s = 0.01;   ///< between two calls of the firmware
  double approach_s = 0.5;  ///< over which the winding may come near its limit: shorter lets peaks through for longer
  GuaranteeOptions guarantee;
};

/// An effect that the observer reckons with.
struct ActingEffect {
  std::string name;
  std::string type;
  std::string equation;
};

struct Derating {
  std::string motor_id;
  std::string robot_id;
  std::string data_quality;
  double torque_constant_Nm_per_A = 0.0;
  Observer observer;
  BarrierRules rules;
  CurrentTable table;
  DerateOptions options;
  std::vector<ActingEffect> effects;
  Guarantee guarantee;
  std::vector<UsePlayed> uses;
};

/// Finds the smallest reserve of heat with which the share of motors that is asked for keeps every limit in every use, and checks it on
/// motors that the search has not seen. Throws Failure: bad_input where the period is too long for the
/// motor or the samples are too few for the confidence, limit_exceeded where no
/// reserve helps, because the motor passes a limit without current.
Derating derate(const Motor& motor, const Robot& robot, const DerateOptions& options, const Progress& progress = {});

}  // namespace heatsoak
