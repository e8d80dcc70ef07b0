#pragma once
/// \file Files that libbough.so reads with the system file: .FLX, flat bodies, matrices in the system file itself.
#include "embed/load.hpp"

namespace bough::embed {

FileReaders get_file_readers();

}  // namespace bough::embed
