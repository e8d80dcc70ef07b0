#pragma once
/// \file Files below the working folder: the list of them, texts, and writing a text whose file has not changed.
#include <string>
#include <vector>

namespace bough::cli {

struct FolderEntry {
  std::string name;  ///< relative path with '/'
  std::string kind;  ///< "deck", "body", "system", "campaign", "report", or the format of an HDF5 file
  double size = 0;   ///< [bytes]
  double time = 0;   ///< of the last change [s], of a clock without a meaning for its zero
};

/// Files that the studio shows, by name; at most kMaxEntries of them, from at most kMaxDepth folders down. Hidden files
/// and folders, and links out of the folder, are left out.
constexpr std::size_t kMaxEntries = 1000;
constexpr int kMaxDepth = 4;
/// Lists the files below the present folder in the order of their names; unreadable folders are skipped.
std::vector<FolderEntry> list_folder();

struct FileText {
  std::string text, hash;  ///< hash: SHA-256
};

/// \throws InputError "cli.no-file", "cli.outside-folder", "studio.too-large".
FileText read_file_text(const std::string& name);

/// Writes a text. `hash` is that of the file when it was read; empty for a file that does not exist yet.
/// \return hash of the new file. \throws InputError "studio.changed-file" if the file has another hash,
/// "cli.output-exists" if it exists and `hash` is empty; ComputationError "cli.write".
std::string save_file_text(const std::string& name, const std::string& text, const std::string& hash);

}  // namespace bough::cli
