#pragma once
/// \file Accuracy of a reduced body, as `reduce` computes it in addition to the body.
#include <string>

#include "formats/records/flex_body.hpp"

namespace bough::hdf5 {

/// /accuracy: the modal matrices against those recomputed from the shapes, relative; -1: not known, not written.
struct BodyAccuracy {
  double mass = -1, stiffness = -1;
};

/// Writes the body as write_flex_body of files.hpp does, with its accuracy.
void write_flex_body(const records::FlexBody& body, const BodyAccuracy& accuracy, const std::string& path);

/// Reads the accuracy of a body; opens the file as read_flex_body of files.hpp does.
BodyAccuracy read_body_accuracy(const std::string& path);

}  // namespace bough::hdf5
