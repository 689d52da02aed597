// Writes the synthetic logs of reports/soak, see soak_scenario.h. Every run writes the same bytes.
//   heatsoak_soak_example FOLDER [SEED]     (500, or another seed for other loads and noise)
#include <fmt/format.h>

#include <string>

#include "soak_scenario.h"

int main(int argc, char** argv) {
  if (argc != 2 && argc != 3) {
    fmt::print(stderr, "usage: heatsoak_soak_example FOLDER [SEED]\n");
    return 2;
  }
  heatsoak::attribution::truth::write_soak_logs(argc == 3 ? std::stoull(argv[2]) : 500, argv[1]);
}
