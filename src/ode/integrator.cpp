#include "ode/integrator.h"

#include "ode/solver.h"

namespace heatsoak::ode {

Integrator::Integrator(OdeSystem& system, OdeMethod method, OdeTolerances tolerances)
    : solver_(method == OdeMethod::arkode_erk ? make_arkode_solver(system, tolerances) : make_cvodes_solver(system, method, tolerances)) {}

Integrator::~Integrator() = default;

void Integrator::start(double time_s, std::span<const double> y) { solver_->start(time_s, y); }

OdeStep Integrator::step(double stop_s) { return solver_->integrate(stop_s, OdeSolver::Stride::one_step); }

OdeStep Integrator::advance(double stop_s) { return solver_->integrate(stop_s, OdeSolver::Stride::until_stop); }

std::span<const double> Integrator::state() const { return solver_->state(); }

double Integrator::time_s() const { return solver_->time_s(); }

long Integrator::derivative_count() const { return solver_->derivative_count(); }

}  // namespace heatsoak::ode
