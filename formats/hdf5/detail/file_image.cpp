#include "formats/hdf5/detail/file_image.hpp"

#include <algorithm>

#include "base/diagnostic.hpp"

namespace bough::hdf5 {

namespace {

/// Members of a group that are found one after the other; of more the names are sorted in a B-tree.
constexpr std::size_t kMaxLinks = 32;
/// Bounds of one heap: the number of an object has 16 bits.
constexpr std::size_t kMaxObjects = 30000, kMinHeap = 4096, kMaxHeap = 1 << 20;

std::size_t round_up(std::size_t size) { return (size + 7) / 8 * 8; }

/// A B-tree of version 1 over the leaves (III.A.1): keys are offsets of names in the heap, one more than children.
Address place_group_tree(FileImage& image, std::vector<Address> children, std::vector<std::uint64_t> keys) {
  constexpr std::size_t kMaxChildren = 2 * kGroupK;
  for (int level = 0;; ++level) {
    std::vector<Address> parents;
    std::vector<std::uint64_t> parent_keys{keys.front()};
    const std::size_t num_nodes = (children.size() + kMaxChildren - 1) / kMaxChildren;
    const std::size_t size = 24 + 8 * (2 * kMaxChildren + 1);
    std::vector<Address> places;
    for (std::size_t i = 0; i < num_nodes; ++i) places.push_back(image.reserve(size));
    for (std::size_t i = 0; i < num_nodes; ++i) {
      const std::size_t first = i * kMaxChildren, count = std::min(kMaxChildren, children.size() - first);
      std::string node = "TREE";
      append_number(node, 0, 1);
      append_number(node, static_cast<std::uint64_t>(level), 1);
      append_number(node, count, 2);
      append_number(node, i > 0 ? places[i - 1] : kUndefined, 8);
      append_number(node, i + 1 < num_nodes ? places[i + 1] : kUndefined, 8);
      append_number(node, keys[first], 8);
      for (std::size_t k = first; k < first + count; ++k) {
        append_number(node, children[k], 8);
        append_number(node, keys[k + 1], 8);
      }
      std::copy(node.begin(), node.end(), image.at(places[i]));
      parents.push_back(places[i]);
      parent_keys.push_back(keys[first + count]);
    }
    if (parents.size() == 1) return parents.front();
    children = std::move(parents);
    keys = std::move(parent_keys);
  }
}

}  // namespace

Address FileImage::reserve(std::size_t size) {
  if (hole_ + size <= hole_end_) return std::exchange(hole_, hole_ + size);
  const Address rest = kPage - end() % kPage;
  if (size <= kPage && size > rest && rest < kPage) {
    hole_ = end();
    hole_end_ = hole_ + rest;
    bytes_.resize(bytes_.size() + rest);
  }
  const Address place = end();
  bytes_.resize(bytes_.size() + size);
  return place;
}

Address FileImage::place(const std::string& block) {
  const Address address = reserve(block.size());
  std::copy(block.begin(), block.end(), at(address));
  return address;
}

Address FileImage::place_header(const std::vector<Message>& messages) {
  constexpr std::size_t kContinuation = kMessagePrefix + 16;
  if (calc_header_size(messages) <= kPage) return place(encode_header(messages));
  std::vector<Message> first, rest;
  std::size_t size = kHeaderPrefix + 4 + kContinuation;
  for (const auto& m : messages) {
    size += kMessagePrefix + m.body.size();
    (size <= kPage && rest.empty() ? first : rest).push_back(m);
  }
  const std::string more = encode_continuation(rest);
  std::string body;
  append_number(body, place(more), 8);
  append_number(body, more.size(), 8);
  first.push_back({message::kContinuation, body});
  return place(encode_header(first));
}

void TextHeap::place(FileImage& image) {
  auto next = places_.begin();
  while (next != places_.end()) {
    std::string heap = std::string("GCOL\x01") + std::string(11, '\0');
    const auto first = next;
    unsigned number = 0;
    for (; next != places_.end() && number < kMaxObjects && (number == 0 || heap.size() < kMaxHeap); ++next) {
      append_number(heap, ++number, 2);
      append_number(heap, 0, 6);
      append_number(heap, next->first.size(), 8);
      next->second.data = heap.size();  // from the beginning of the heap
      next->second.number = number;
      heap += next->first;
      heap.resize(round_up(heap.size()));
    }
    // Free space is object 0, with a head like any object.
    const std::size_t used = heap.size(), whole = std::max(used, kMinHeap);
    heap.resize(whole);
    if (whole - used >= 16) set_number(heap.data() + used + 8, whole - used, 8);
    set_number(heap.data() + 8, whole, 8);
    const Address address = image.place(heap);
    for (auto it = first; it != next; ++it) {
      it->second.heap = address;
      it->second.data += address;
    }
  }
}

std::string TextHeap::encode(const std::string& text, std::uint64_t length) const {
  std::string reference;
  const Place place = text.empty() ? Place{} : places_.at(text);
  append_number(reference, length, 4);
  append_number(reference, place.heap, 8);
  append_number(reference, place.number, 4);
  return reference;
}

GroupTree& GroupTree::make_group(const std::string& path) {
  GroupTree* group = this;
  for (std::size_t begin = 1; begin < path.size();) {
    const auto end = std::min(path.find('/', begin), path.size());
    group = &group->members_[path.substr(begin, end - begin)];
    begin = end + 1;
  }
  return *group;
}

void GroupTree::add_object(const std::string& path, Address header) { make_group(path).header_ = header; }

void GroupTree::place_members(FileImage& image) {
  for (auto& [unused, member] : members_) {
    if (member.header_ != kUndefined) continue;
    member.place_members(image);
    member.place(image);
  }
}

Address GroupTree::place(FileImage& image) {
  auto messages = attributes_;
  const auto links = make_links(image);
  messages.insert(messages.end(), links.begin(), links.end());
  return header_ = image.place_header(messages);
}

std::vector<Message> GroupTree::make_links(FileImage& image) const {
  if (members_.size() <= kMaxLinks) {
    auto links = make_group_messages();
    for (const auto& [name, member] : members_) links.push_back(make_link(name, member.header_));
    return links;
  }
  // Local heap of the names, leaves of their addresses in the order of names, and the tree over them.
  std::string names(8, '\0');
  std::vector<Address> leaves;
  std::vector<std::uint64_t> keys{0};
  for (auto it = members_.begin(); it != members_.end();) {
    std::string leaf = std::string("SNOD\x01") + '\0', entries;
    std::uint64_t count = 0;
    for (; it != members_.end() && count < 2 * kGroupLeafK; ++it, ++count) {
      append_number(entries, names.size(), 8);
      append_number(entries, it->second.header_, 8);
      entries.append(24, '\0');
      if (count + 1 == 2 * kGroupLeafK || std::next(it) == members_.end()) keys.push_back(names.size());
      names += it->first;
      names.resize(round_up(names.size() + 1));
    }
    append_number(leaf, count, 2);
    leaf += entries;
    leaf.resize(8 + 40 * 2 * kGroupLeafK);
    leaves.push_back(image.place(leaf));
  }
  std::string heap = std::string("HEAP") + std::string(4, '\0');
  append_number(heap, names.size(), 8);
  append_number(heap, 1, 8);  // nothing is free
  append_number(heap, image.place(names), 8);
  std::string body;
  append_number(body, place_group_tree(image, leaves, keys), 8);
  append_number(body, image.place(heap), 8);
  return {{message::kSymbolTable, body}};
}

}  // namespace bough::hdf5
