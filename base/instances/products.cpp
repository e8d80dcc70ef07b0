#define BOUGH_PRODUCTS
#include "base/products.hpp"
