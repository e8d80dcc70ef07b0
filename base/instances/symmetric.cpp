#define BOUGH_INSTANCE
#define BOUGH_INSTANCES_OF 1
#include "base/decompositions.hpp"
