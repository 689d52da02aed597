#include "cli/command.h"

int main(int argc, char** argv) { return heatsoak::cli::run_program(argc, argv); }
