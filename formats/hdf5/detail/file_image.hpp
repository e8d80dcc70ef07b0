#pragma once
/// \file Metadata of an HDF5 file, laid out in memory.
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "formats/hdf5/detail/object_header.hpp"

namespace bough::hdf5 {

/// Bytes that the system writes at once or not at all, also when a write is cut by a kill.
inline constexpr std::size_t kPage = 4096;

/// Blocks from an address on. A block that fits into a page crosses no border of one: it is replaced as a whole.
class FileImage {
 public:
  explicit FileImage(Address begin) : begin_(begin) {}

  /// Address of the first byte in the file.
  Address begin() const { return begin_; }
  /// Address after the last byte.
  Address end() const { return begin_ + bytes_.size(); }
  /// The bytes from begin() to end().
  const std::string& bytes() const { return bytes_; }
  /// Returns the byte at an address of the file; valid until the next block is added. \pre begin() <= address < end().
  char* at(Address address) { return bytes_.data() + (address - begin_); }

  /// Space for a block, zero.
  Address reserve(std::size_t size);
  /// Copies a block to new space and returns its address.
  Address place(const std::string& block);
  /// An object header. One that does not fit into a page goes on in a continuation block; its first messages stay.
  Address place_header(const std::vector<Message>& messages);

 private:
  Address begin_;
  Address hole_ = 0, hole_end_ = 0;  ///< left free by the last block that began on a new page
  std::string bytes_;
};

/// Texts of variable length and other objects of global heaps (III.E); equal ones are one.
class TextHeap {
 public:
  /// Adds a text before place(); a text that is there already is shared.
  void add(const std::string& text) { places_.emplace(text, Place{}); }
  /// Writes the heaps of all texts into the image and stores their addresses.
  void place(FileImage& image);
  /// The reference to a text that was added: length, heap, number. An empty text needs no heap.
  std::string encode(const std::string& text, std::uint64_t length) const;
  std::string encode(const std::string& text) const { return encode(text, text.size()); }
  /// Address of the bytes of a text that was added.
  Address find(const std::string& text) const { return places_.at(text).data; }

 private:
  struct Place {
    Address heap = 0, data = 0;
    unsigned number = 0;
  };
  std::map<std::string, Place> places_;
};

/// Names of objects by group, and the headers of these groups.
class GroupTree {
 public:
  /// A group at the path, made where it is absent.
  GroupTree& make_group(const std::string& path);
  /// Sets the object header at the path; groups above are made.
  void add_object(const std::string& path, Address header);
  /// Adds an attribute to this group.
  void add_attribute(Message attribute) { attributes_.push_back(std::move(attribute)); }
  /// Places the headers of this group's members, from the leaves up; placed headers do not move.
  void place_members(FileImage& image);
  /// After place_members.
  Address place(FileImage& image);
  /// Links of the members.
  std::vector<Message> make_links(FileImage& image) const;

 private:
  std::map<std::string, GroupTree> members_;
  std::vector<Message> attributes_;
  Address header_ = kUndefined;
};

/// K of the B-trees of groups and half the names in a leaf, as the library has them.
inline constexpr int kGroupK = 16, kGroupLeafK = 4;

}  // namespace bough::hdf5
