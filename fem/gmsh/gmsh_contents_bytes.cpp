#include "fem/gmsh/gmsh_contents_bytes.h"

#include "tools/support/files/bytes.h"

namespace sprung::fem {

namespace {

// `contents` is constant for a ByteWriter.
template <class Bytes, class Contents>
void transfer(Bytes& bytes, Contents& contents) {
  const auto number = [&](auto& value) { bytes.transfer(value); };
  bytes.transfer_items(contents.nodes, [&](auto& node) {
    number(node.id);
    for (int i = 0; i < 3; ++i) number(node.position[i]);
  });
  bytes.transfer_items(contents.points, [&](auto& point) {
    number(point.id);
    number(point.node);
    bytes.transfer_items(point.groups, number);
  });
  bytes.transfer_items(contents.lines, [&](auto& line) {
    number(line.id);
    number(line.first);
    number(line.second);
    number(line.curve);
    bytes.transfer_items(line.groups, number);
  });
  bytes.transfer_items(contents.groups, [&](auto& group) {
    number(group.dimension);
    number(group.tag);
    bytes.transfer(group.name);
  });
}

}  // namespace

std::string pack(const GmshContents& contents) {
  support::ByteWriter writer;
  transfer(writer, contents);
  return writer.bytes();
}

GmshContents unpack(std::string_view bytes) {
  support::ByteReader reader(bytes);
  GmshContents contents;
  transfer(reader, contents);
  if (!reader.at_end()) throw support::DamagedBytes();
  return contents;
}

}  // namespace sprung::fem
