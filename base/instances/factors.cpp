#define BOUGH_INSTANCE
#define BOUGH_INSTANCES_OF 3
#include "base/decompositions.hpp"
