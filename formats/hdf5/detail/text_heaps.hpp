#pragma once
/// \file Where strings of variable length lie in a file: the references to them, checked before the library follows
/// any.
#include <map>
#include <vector>

#include "formats/hdf5/detail/handle.hpp"

namespace bough::hdf5 {

/// The global heaps of one open file. The library (1.10) takes the heap, the number in it and the length that a
/// reference tells without looking whether there is such an object, and copies what is there, whatever it is. HDF5 File
/// Format Specification, Version 3.0, III.E (global heap), IV.A.2.d (variable-length datatype).
class TextHeaps {
 public:
  explicit TextHeaps(hid_t file);

  /// Bytes of a reference in the file: length, address of the heap, number in it.
  std::size_t reference_size() const { return 4 + address_size_ + 4; }
  /// The type in memory that references are read as, as they lie in the file; owned by this.
  hid_t reference_type() const { return type_.get(); }
  /// Returns true if each reference points to an object of its length, or is of an empty string.
  bool holds(const std::vector<char>& references);

 private:
  using Sizes = std::map<unsigned, double>;  ///< by number in the heap
  const Sizes& get_heap(double address);
  Sizes read_heap(double address) const;

  int descriptor_ = -1;
  double begin_ = 0;  ///< of addresses, after data that are not HDF5's
  std::size_t address_size_ = 8, length_size_ = 8;
  Handle type_;
  std::map<double, Sizes> heaps_;
};

}  // namespace bough::hdf5
