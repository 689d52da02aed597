// CMake requires a library to have a source file.
#include "precompiled_tests.h"
