#include "errors_of_models.h"

#include <utility>

#include "estimation/log_columns.h"

namespace heatsoak::attribution {

ErrorsOfModels errors_of_models(const diagnosis::DiagnosisInput& input, const diagnosis::Diagnosis& diagnosis,
                                std::vector<estimation::MeasuredRun> unseen) {
  ErrorsOfModels errors;
  const estimation::Model& after = diagnosis.selection.after.model;
  estimation::set_columns(unseen, after.columns);
  errors.before = estimation::open_loop_errors(input.model, unseen, diagnosis.runs);
  errors.refitted = estimation::open_loop_errors(diagnosis.selection.own.model, unseen, diagnosis.runs);
  errors.after = estimation::open_loop_errors(after, unseen, diagnosis.runs);
  errors.runs = std::move(unseen);
  return errors;
}

}  // namespace heatsoak::attribution
