#pragma once
/// \file A deck, system, body or flexible-body file in other units; comments and order are kept.
#include <functional>
#include <string>
#include <vector>

#include "analysis/common/events.hpp"
#include "formats/hdf5/body_accuracy.hpp"
#include "formats/records/flex_body.hpp"

namespace bough::analysis {

struct ConvertRequest {
  std::string file;         ///< Nastran deck with its INCLUDE files, system or body file, flexible body
  std::string output;       ///< path of the converted file; INCLUDE files are put next to it
  std::string units;        ///< "FROM:TO", as "mm-N-tonne:m-kg-s"; empty: `from` and `to`
  std::string from, to;     ///< as "mm-N-tonne"; empty: no change of units
  bool to_radians = false;  ///< system file: keys in degrees (_deg) become radians
};

enum class ConvertedKind { Deck, Toml, FlexBody };

struct ConvertAnswer {
  struct File {
    std::string path, text;
  };
  ConvertedKind kind = ConvertedKind::Deck;
  std::string from, to;         ///< names of the units; empty: unchanged
  std::vector<File> files;      ///< in the order in which to write them; empty if `body` goes into an HDF5 file
  std::size_t num_changed = 0;  ///< fields of a deck, values of a TOML file
  records::FlexBody body;       ///< of a flexible-body file
  hdf5::BodyAccuracy accuracy;  ///< of the body in an HDF5 file
};

/// Called with each path that is to be written and the files that were read; may throw.
using CheckPath = std::function<void(const std::string& path, const std::vector<std::string>& inputs)>;

/// Throws InputError "cli.bad-units" and what the readers report; writes no file.
ConvertAnswer convert_file(const ConvertRequest& request, const CheckPath& check, Events& events);

}  // namespace bough::analysis
