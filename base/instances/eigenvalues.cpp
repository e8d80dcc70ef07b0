#define BOUGH_INSTANCE
#define BOUGH_INSTANCES_OF 2
#include "base/decompositions.hpp"
