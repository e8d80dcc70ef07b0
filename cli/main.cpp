#include <cstdio>

#include "bough/base/version.hpp"

int main() { std::printf("bough %s\n", bough::get_version()); }
