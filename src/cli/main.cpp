#include "cli/command.h"

int main(int argc, char** argv) { return heatsoak::run_program(argc, argv); }
