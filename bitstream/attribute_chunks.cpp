// The part of the parser that takes what a mesh carries beside positions.
#include <algorithm>
#include <string>
#include <utility>

#include "bitstream/bytes.h"
#include "bitstream/container_parser.h"
#include "bitstream/syntax.h"

namespace reeb {
namespace {

Status corrupt(const Chunk& chunk, const std::string& what) {
  return Status::corrupt(to_string(chunk.type) + " at byte " + std::to_string(chunk.offset) + ": " +
                         what);
}

}  // namespace

Status ContainerParser::take_attribute(const Chunk& chunk) {
  AttributeChunk a;
  a.offset = chunk.offset;
  a.size = chunk.size;
  ByteReader in(chunk.payload);
  if (Status s = read_header(in, "attr", a.header); !s.ok()) return s;
  const AttributeHeader& h = a.header;
  const auto& known = out_.attributes;
  const bool same_shot = !known.empty() && known.back().header.shot == h.shot;
  const uint32_t before = same_shot ? known.back().header.index : 0;
  if (!known.empty() && known.back().header.shot > h.shot)
    return corrupt(chunk, "shots out of order");
  if (same_shot && h.index <= before) return corrupt(chunk, "attributes out of order");
  if (intact() && h.index != (same_shot ? before + 1 : 0))
    return corrupt(chunk, "attributes are not consecutive");
  if (intact() && (out_.references.empty() || out_.references.back().header.shot != h.shot))
    return corrupt(chunk, "no reference mesh of its shot before it");
  if (Status s = spend(text_memory(h.name), out_.lease); !s.ok()) return s;
  if (Status s = make_room(out_.attributes, out_.lease); !s.ok()) return s;
  out_.attributes.push_back(std::move(a));
  count("attributes", chunk.size);
  return {};
}

Status ContainerParser::take_attribute_group(const Chunk& chunk) {
  AttributeGroupChunk a;
  a.offset = chunk.offset;
  a.size = chunk.size;
  ByteReader in(chunk.payload);
  if (Status s = read_header(in, "agrp", a.header); !s.ok()) return s;
  const AttributeGroupHeader& h = a.header;
  if (!out_.attribute_groups.empty()) {
    const AttributeGroupHeader& last = out_.attribute_groups.back().header;
    if (std::pair(h.first_frame, h.index) <= std::pair(last.first_frame, last.index))
      return corrupt(chunk, "groups of attributes out of order");
  }
  const AttributeChunk* attribute = out_.attribute(h.shot, h.index);
  if (attribute == nullptr ? intact() : !attribute->header.in_groups())
    return corrupt(chunk, "no animated attribute of this index");
  const GroupHeader* group = out_.groups.empty() ? nullptr : &out_.groups.back().header;
  if (intact() && (group == nullptr || group->shot != h.shot ||
                   group->first_frame != h.first_frame || group->frame_count != h.frame_count))
    return corrupt(chunk, "its frames are not those of the group before it");
  if (Status s = make_room(out_.attribute_groups, out_.lease); !s.ok()) return s;
  out_.attribute_groups.push_back(a);
  count("animated attributes", chunk.size);
  return {};
}

Status ContainerParser::take_resource(const Chunk& chunk) {
  ResourceChunk r;
  r.offset = chunk.offset;
  r.size = chunk.size;
  ByteReader in(chunk.payload);
  if (Status s = read_header(in, "rsrc", r.header); !s.ok()) return s;
  const uint64_t texts = text_memory(r.header.name) + text_memory(r.header.media_type);
  if (Status s = spend(texts, out_.lease); !s.ok()) return s;
  if (Status s = make_room(out_.resources, out_.lease); !s.ok()) return s;
  out_.resources.push_back(std::move(r));
  count("resources", chunk.size);
  return {};
}

Status ContainerParser::take_bounds(const Chunk& chunk) {
  if (!out_.bounds.empty()) return corrupt(chunk, "a second one");
  GroupBoxes bounds;
  ByteReader in(chunk.payload);
  const uint64_t most = chunk.payload_size / sizeof(Box);
  const uint64_t boxes = std::min(ByteReader(chunk.payload).varuint(), most);
  if (Status s = spend(boxes * sizeof(Box), out_.lease); !s.ok()) return s;
  if (Status s = read_header(in, "bnds", bounds); !s.ok()) return s;
  if (in.position() != chunk.payload_size) return corrupt(chunk, "bytes after the last field");
  for (const Box& box : bounds.groups) {
    for (int axis = 0; axis < 3; ++axis) {
      if (box.low[axis] > box.high[axis]) return corrupt(chunk, "a box is inside out");
    }
  }
  out_.bounds = std::move(bounds.groups);
  count("bounds", chunk.size);
  return {};
}

}  // namespace reeb
