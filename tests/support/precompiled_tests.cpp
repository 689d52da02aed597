// A library wants a file.
#include "precompiled_tests.h"
