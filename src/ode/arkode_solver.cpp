// Explicit one-step method: Dormand-Prince 5(4).
#include <arkode/arkode_erkstep.h>

#include "ode/solver.h"

namespace heatsoak::ode {
namespace {

class ArkodeSolver final : public OdeSolver {
 public:
  ArkodeSolver(OdeSystem& system, OdeTolerances tolerances)
      : OdeSolver(system), memory_(ERKStepCreate(derivative, 0.0, y(), context()), [](void* each) { ERKStepFree(&each); }) {
    check(ERKStepSetErrHandlerFn(memory_.get(), keep_reason, self()));
    check(ERKStepSetUserData(memory_.get(), self()));
    check(ERKStepSetTableNum(memory_.get(), ARKODE_DORMAND_PRINCE_7_4_5));
    check(ERKStepSStolerances(memory_.get(), tolerances.relative, tolerances.absolute));
    check(ERKStepSetMaxNumSteps(memory_.get(), kMaximumSteps));
    if (event_count() > 0) {
      check(ERKStepRootInit(memory_.get(), event_count(), events));
      check(ERKStepSetNoInactiveRootWarn(memory_.get()));
    } else {
      // Without events nothing is interpolated; the default interpolant of degree 4 costs one more call per stop.
      check(ERKStepSetInterpolantDegree(memory_.get(), 1));
    }
  }

 private:
  void restart(StepSize step_size) override {
    // Reset keeps the step size and the history of the step controller; ReInit searches for a first step again.
    check(step_size == StepSize::keep ? ERKStepReset(memory_.get(), time_s(), y())
                                      : ERKStepReInit(memory_.get(), derivative, time_s(), y()));
  }

  double internal_time_s() const override {
    double internal_s = 0.0;
    ERKStepGetCurrentTime(memory_.get(), &internal_s);
    return internal_s;
  }

  void set_stop(double stop_s) override { check(ERKStepSetStopTime(memory_.get(), stop_s)); }

  bool evolve(double stop_s, Stride stride, double& reached_s) override {
    const int task = stride == Stride::one_step ? ARK_ONE_STEP : ARK_NORMAL;
    const int flag = ERKStepEvolve(memory_.get(), stop_s, y(), &reached_s, task);
    check(flag);
    return flag == ARK_ROOT_RETURN;
  }

  void read_crossed(int* crossed) override { check(ERKStepGetRootInfo(memory_.get(), crossed)); }

  SundialsHandle<void> memory_;
};

}  // namespace

std::unique_ptr<OdeSolver> make_arkode_solver(OdeSystem& system, OdeTolerances tolerances) {
  return std::make_unique<ArkodeSolver>(system, tolerances);
}

}  // namespace heatsoak::ode
