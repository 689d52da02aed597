// Document and JSON of `steady`.
#pragma once

#include "motor/on_off_load.h"
#include "present/document.h"
#include "present/json.h"

namespace heatsoak::present {

Document steady_document(const motor::OnOffAnswer& answer);
Json steady_json(const motor::OnOffAnswer& answer);

}  // namespace heatsoak::present
