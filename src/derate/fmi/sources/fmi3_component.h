#ifndef FMI3_COMPONENT_H
#define FMI3_COMPONENT_H

#include "fmi3.h"

/* Logs the problem of an instance, if there is one. Returns the FMI status. */
fmi3Status fmi3_refuse(fmi3Instance of, const char *problem);

#endif
