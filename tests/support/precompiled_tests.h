// Precompiled headers of the test programs, like cmake/precompiled.h.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../cmake/precompiled.h"
