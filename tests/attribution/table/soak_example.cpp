// Writes the synthetic logs of reports/soak, see soak_scenario.h. Every run writes the same bytes.
//   heatsoak_soak_example FOLDER [SEED]     (500, or another seed for other loads and noise)
#include "../../support/study_words.h"
#include "soak_scenario.h"

int main(int argc, char** argv) {
  return heatsoak::run_study(argc, argv, "usage: heatsoak_soak_example FOLDER [SEED]\n", 2, [](const heatsoak::StudyWords& words) {
    heatsoak::attribution::truth::write_soak_logs(words.whole(1, "SEED", 0, 500), words.required(0, "FOLDER"));
    return 0;
  });
}
