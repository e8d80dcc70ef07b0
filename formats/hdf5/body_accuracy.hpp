#pragma once
/// \file What `reduce` says of a body besides the body itself.
#include <string>

#include "formats/records/flex_body.hpp"

namespace bough::hdf5 {

/// /accuracy: the modal matrices against those made anew from the shapes, relative; -1: not known, not written.
struct BodyAccuracy {
  double mass = -1, stiffness = -1;
};

/// As write_flex_body of files.hpp.
void write_flex_body(const records::FlexBody& body, const BodyAccuracy& accuracy, const std::string& path);

/// What the file says of itself. As read_flex_body of files.hpp.
BodyAccuracy read_body_accuracy(const std::string& path);

}  // namespace bough::hdf5
