// Multistep methods: BDF with Newton and a dense difference-quotient Jacobian, Adams with fixed-point iteration.
#include <cvodes/cvodes.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_nonlinearsolver.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include "ode/solver.h"

namespace heatsoak::ode {
namespace {

class CvodesSolver final : public OdeSolver {
 public:
  CvodesSolver(OdeSystem& system, OdeMethod method, OdeTolerances tolerances)
      : OdeSolver(system),
        jacobian_(nullptr, SUNMatDestroy),
        linear_(nullptr, [](SUNLinearSolver each) { SUNLinSolFree(each); }),
        fixed_point_(nullptr, [](SUNNonlinearSolver each) { SUNNonlinSolFree(each); }),
        memory_(CVodeCreate(method == OdeMethod::cvodes_bdf ? CV_BDF : CV_ADAMS, context()), [](void* each) { CVodeFree(&each); }) {
    check(CVodeSetErrHandlerFn(memory_.get(), keep_reason, self()));
    check(CVodeInit(memory_.get(), derivative, 0.0, y()));
    check(CVodeSetUserData(memory_.get(), self()));
    check(CVodeSStolerances(memory_.get(), tolerances.relative, tolerances.absolute));
    check(CVodeSetMaxNumSteps(memory_.get(), kMaximumSteps));
    if (method == OdeMethod::cvodes_bdf) {
      jacobian_.reset(SUNDenseMatrix(system.size(), system.size(), context()));
      linear_.reset(SUNLinSol_Dense(y(), jacobian_.get(), context()));
      check(CVodeSetLinearSolver(memory_.get(), linear_.get(), jacobian_.get()));
    } else {
      fixed_point_.reset(SUNNonlinSol_FixedPoint(y(), 0, context()));
      check(CVodeSetNonlinearSolver(memory_.get(), fixed_point_.get()));
    }
    if (event_count() > 0) {
      check(CVodeRootInit(memory_.get(), event_count(), events));
      check(CVodeSetNoInactiveRootWarn(memory_.get()));
    }
  }

 private:
  void restart(StepSize /*step_size*/) override {
    // At order one the previous step size is far too large. Keeping the last first step would save 2 of 22 calls per interval, but one
    // short interval would shrink it for all later ones.
    check(CVodeReInit(memory_.get(), time_s(), y()));
  }

  double internal_time_s() const override {
    double internal_s = 0.0;
    CVodeGetCurrentTime(memory_.get(), &internal_s);
    return internal_s;
  }

  void set_stop(double stop_s) override { check(CVodeSetStopTime(memory_.get(), stop_s)); }

  bool evolve(double stop_s, Stride stride, double& reached_s) override {
    const int task = stride == Stride::one_step ? CV_ONE_STEP : CV_NORMAL;
    const int flag = CVode(memory_.get(), stop_s, y(), &reached_s, task);
    check(flag);
    return flag == CV_ROOT_RETURN;
  }

  void read_crossed(int* crossed) override { check(CVodeGetRootInfo(memory_.get(), crossed)); }

  SundialsHandle<_generic_SUNMatrix> jacobian_;
  SundialsHandle<_generic_SUNLinearSolver> linear_;
  SundialsHandle<_generic_SUNNonlinearSolver> fixed_point_;
  SundialsHandle<void> memory_;
};

}  // namespace

std::unique_ptr<OdeSolver> make_cvodes_solver(OdeSystem& system, OdeMethod method, OdeTolerances tolerances) {
  return std::make_unique<CvodesSolver>(system, method, tolerances);
}

}  // namespace heatsoak::ode
