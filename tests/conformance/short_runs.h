// Command lines that answer quickly, and the names of all verbs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "program_run.h"
#include "support/source_folder.h"

namespace heatsoak {

inline const Words kShortSteady{"steady",     "--motor", "maxon_ec45_flat_70w_24v", "--current-on", "6A", "--time-on", "4s",
                                "--time-off", "6s"};
inline const Words kShortEvaluate{"evaluate",
                                  "--robot",
                                  "roboteam_twente_v2024",
                                  "--duty",
                                  "paper_intermittent",
                                  "--motors",
                                  "maxon_ec45_flat_70w_24v, maxon_ecx_flat_32l_48v"};
inline const Words kShortSimulate{"simulate", "--motor",           "maxon_ec45_flat_70w_24v", "--robot", "roboteam_twente_v2024",
                                  "--duty",   "paper_intermittent"};

inline const std::filesystem::path kFrictionLog = kSource / "reports/friction_test/steady_state_test.csv";

/// Returns the verbs that have a reference page. Tests are listed from these names, which need no run of the program.
inline std::vector<std::string> verb_names() {
  std::vector<std::string> names;
  for (const std::string& page : files_of(kSource / "docs" / "reference", "", ".md")) {
    if (page != "README.md") {
      names.push_back(std::filesystem::path(page).stem().string());
    }
  }
  return names;
}

}  // namespace heatsoak
