#include "planner_records.h"
#include "replay.h"

int main() {
  using namespace heatsoak::target;
  replay<PlannerRecord, PlannerResult>(run_planner, clear_unused, 0);
  return 0;
}
