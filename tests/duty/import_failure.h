// Returns the error message of an import that fails.
#pragma once

#include <gtest/gtest.h>

#include "base/diagnostic.h"
#include "duty/recorded_game.h"
#include "ssl_log_writer.h"

namespace heatsoak::duty {

inline std::string failure_of(const std::string& bytes, const std::string& name = "game.log") {
  const testing_logs::TemporaryFile file(name, bytes);
  try {
    (void)import_game(file.path());
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
    return failure.what();
  }
  return "no failure";
}

}  // namespace heatsoak::duty
