"""Streams of class *faulty*: sound ones taken apart, damaged, and put together again."""
import math
import pathlib
import struct

from stream_parts import f64, File, flipped, read_group, read_reference, UINT32, uv, with_bits


class Maker:
    def __init__(self, folder):
        self.folder = folder
        self.made = []

    def sound(self, name):
        for kind in ("core", "uncommon"):
            path = self.folder / kind / (name + ".reeb")
            if path.exists():
                return path.read_bytes()
        raise KeyError(name)

    def add(self, name, status, sentence, data):
        folder = self.folder / "faulty"
        folder.mkdir(exist_ok=True)
        data = data.pack() if isinstance(data, File) else data
        (folder / (name + ".reeb")).write_bytes(data)
        self.made.append(("faulty", name, status, sentence))


def add_ends(m):
    """Files that end early."""
    data = m.sound("groups")
    at = File(data).offsets()
    m.add("empty", "truncated", "No byte at all.", b"")
    m.add("ends_in_signature", "truncated", "Five bytes.", data[:5])
    m.add("ends_in_head", "truncated", "The file ends in HEAD.", data[:12])
    m.add("ends_in_mesh", "truncated", "The file ends in the reference mesh.", data[:at[1] + 20])
    m.add("ends_in_group", "truncated", "The file ends in the third group; two are whole.", data[:at[5] - 9])
    m.add("ends_after_group", "truncated", "The file ends behind its second group.", data[:at[4]])
    m.add("ends_in_table", "truncated", "The file ends in its seek table; all groups are whole.", data[:at[-1] + 9])
    m.add("no_seek_table", "truncated", "The file ends before its seek table; all groups are whole.", data[:at[-1]])
    m.add("no_trailer", "truncated", "The trailer is missing.", data[:-8])


def add_checksums(m):
    """A bit flipped in a chunk."""
    data = m.sound("groups")
    at = File(data).offsets()
    m.add("damaged_head", "corrupt", "HEAD has a wrong checksum.", flipped(data, at[0] + 6))
    m.add("damaged_mesh", "corrupt", "The reference mesh has a wrong checksum.", flipped(data, at[1] + 40))
    m.add("damaged_group", "corrupt", "The second of four groups has a wrong checksum.", flipped(data, at[3] + 30))
    m.add("damaged_first_group", "corrupt", "The first group has a wrong checksum.", flipped(data, at[2] + 30))
    m.add("damaged_last_group", "corrupt", "The last group has a wrong checksum.", flipped(data, at[5] + 30))
    m.add("damaged_type", "corrupt", "A group's type is no letters; the seek table leads past it.",
          data[:at[3]] + b"\1\2\3\4" + data[at[3] + 4:])
    m.add("damaged_length", "corrupt", "A group's length leads astray; the seek table leads back.",
          data[:at[3] + 4] + b"\xFF\xFF\x7F" + data[at[3] + 7:])
    m.add("damaged_length_no_table", "truncated", "The same without a seek table: the rest is lost.",
          (data[:at[3] + 4] + b"\xFF\xFF\x7F" + data[at[3] + 7:])[:at[-1]])
    m.add("damaged_table", "ok", "The seek table has a wrong checksum; nothing is lost.", flipped(data, at[-1] + 8))
    m.add("damaged_trailer", "ok", "The trailer leads nowhere; nothing is lost.", data[:-8] + b"\0\0\0\0reeb")
    m.add("damaged_table_length", "truncated", "The seek table's length leads past the end; all groups are whole.",
          data[:at[-1] + 4] + b"\x7F" + data[at[-1] + 5:])
    m.add("damaged_last_length", "corrupt", "The last group's length leads past the end; the table knows where `seek` is.",
          data[:at[5] + 4] + b"\xFF\xFF\x7F" + data[at[5] + 7:])
    m.add("damaged_end_mark", "ok", "The letters of the trailer are wrong; nothing is lost.", data[:-4] + b"reef")
    m.add("bytes_after_trailer", "ok", "Bytes behind the trailer, which is none then; nothing is lost.", data + b"\0" * 9)
    m.add("short_trailer", "truncated", "Seven bytes of a trailer; nothing is lost.", data[:-1])
    m.add("damaged_type_no_table", "truncated", "A group's type is no letters, and no table leads past it: the rest is lost.",
          data[:at[3]] + b"\1\2\3\4" + data[at[3] + 4:-8] + b"\0\0\0\0reeb")
    shots = m.sound("shots")
    shot_at = File(shots).offsets()
    second = File(shots).places(b"REFM")[1]
    m.add("damaged_shot", "corrupt", "The mesh of the second of three shots is lost, and its group with it.",
          flipped(shots, shot_at[second] + 30))


def add_containers(m):
    data = m.sound("groups")
    file = File(data)
    m.add("wrong_signature", "corrupt", "Line ends were changed on the way.", data.replace(b"\r\n", b"\n", 1))
    m.add("next_version", "unsupported", "format_version 2.", data[:7] + b"\2" + data[8:])
    m.add("unknown_critical", "unsupported", "An unknown chunk that may not be skipped.",
          file.inserted(2, b"Xtra", b"abc"))
    m.add("second_head", "corrupt", "HEAD twice.", file.inserted(1, *file.chunks[0]))
    m.add("no_head", "corrupt", "No HEAD.", file.without(0))
    m.add("no_mesh", "corrupt", "Groups without a reference mesh.", file.without(1))
    m.add("missing_group", "corrupt", "A gap between groups.", file.without(3))
    m.add("missing_last_group", "corrupt", "Fewer frames than HEAD announces.", file.without(5))
    m.add("repeated_group", "corrupt", "A group twice.", file.inserted(3, *file.chunks[2]))
    m.add("mesh_after_group", "corrupt", "A second reference mesh of the only shot.",
          file.inserted(3, *file.chunks[1]))
    m.add("wrong_table", "corrupt", "The seek table has another size of a chunk.",
          file.pack(file.seek_table()[:-1] + b"\1"))
    m.add("short_table", "corrupt", "The seek table has no entries.", file.pack(b"\0"))
    m.add("endless_table", "corrupt", "The seek table announces 2^62 entries.", file.pack(uv(1 << 62)))
    m.add("long_table", "corrupt", "Bytes behind the seek table's last entry.", file.pack(file.seek_table() + b"\0"))
    m.add("endless_metadata", "corrupt", "Metadata announces 2^62 entries.", file.inserted(1, b"meta", uv(1 << 62)))
    for number, (text, sentence) in enumerate((
            (b"\x80", "A byte that continues no letter."), (b"\xC1\xBF", "A letter of one byte in two."),
            (b"\xE0\x9F\xBF", "A letter of two bytes in three."), (b"\xED\xA0\x80", "A surrogate."),
            (b"\xF0\x8F\xBF\xBF", "A letter of three bytes in four."), (b"\xF4\x90\x80\x80", "A letter above U+10FFFF."),
            (b"\xF5\x80\x80\x80", "A byte that starts no letter."), (b"\xC2", "A letter that breaks off."),
            (b"\xE1\x80\xC0", "A letter that another breaks into."), (b"\xE1\x80\x7F", "The same from below."))):
        m.add("text_%d" % (number + 1), "corrupt", sentence,
              file.inserted(1, b"meta", b"\1\0" + uv(len(text)) + text))
    m.add("endless_text", "corrupt", "A key of 2^40 bytes.", file.inserted(1, b"meta", b"\1" + uv(1 << 40)))


def add_headers(m):
    file = File(m.sound("groups"))
    nan, infinite = struct.pack("<f", math.nan), struct.pack("<f", math.inf)
    for name, sentence, changes in (
            ("no_frames", "total_frames 0.", dict(total_frames=0)),
            ("padded_number", "A padded number.", dict(total_frames=b"\x8F\x00")),
            ("eleven_bytes", "A number of eleven bytes.", dict(total_frames=b"\x8F" * 10 + b"\1")),
            ("above_64_bits", "A number above 2^64.", dict(total_frames=b"\xFF" * 9 + b"\2")),
            ("more_shots", "More shots than frames.", dict(shot_count=16)),
            ("missing_shot", "A shot that does not come.", dict(shot_count=2)),
            ("head_flags", "A reserved bit of HEAD.", dict(flags=b"\x80")),
            ("negative_rate", "A negative frame rate.", dict(rates=f64(-24.0) + f64(0.0))),
            ("rate_not_a_number", "A frame rate that is no number.", dict(rates=f64(math.nan) + f64(0.0))),
            ("rate_too_high", "A frame rate above 10^9.", dict(rates=f64(1.0625e9) + f64(0.0))),
            ("start_too_late", "A start_time above 10^15.", dict(rates=f64(24.0) + f64(1.0625e15))),
            ("start_too_early", "A start_time below -10^15.", dict(rates=f64(24.0) + f64(-1.0625e15))),
            ("padded_real", "A real with a 0 at its end.", dict(rates=b"\3\x40\x38\x00" + f64(0.0))),
            ("head_too_long", "A byte behind the last field of HEAD.", dict(flags=b"\0\0"))):
        m.add(name, "corrupt", sentence, file.edited(b"HEAD", **changes))
    m.add("too_many_frames", "limit exceeded", "2^32 - 1 frames, more than a decoder need allow.",
          file.edited(b"HEAD", total_frames=UINT32))
    m.add("limit_before_places", "limit exceeded", "2^25 vertices of a shot that is not announced: the limit goes first.",
          file.edited(b"REFM", vertex_count=1 << 25, shot=1))
    unknown = File(m.sound("open_ended"))
    m.add("open_ended_empty", "corrupt", "An open-ended file without a shot.",
          unknown.only(b"HEAD"))
    m.add("open_ended_no_group", "corrupt", "An open-ended file whose shot has no group.", unknown.only(b"HEAD", b"REFM"))
    m.add("open_ended_too_long", "limit exceeded", "A group of an open-ended file that ends behind 2^32 frames.",
          unknown.edited(b"GRUP", first_frame=UINT32))
    m.add("open_ended_without_end", "truncated", "An open-ended file that ends behind its second group.",
          m.sound("open_ended")[:File(m.sound("open_ended")).offsets()[4]])
    for name, sentence, changes in (
            ("origin_infinite", "An infinite origin.", dict(origin=infinite * 3)),
            ("grid_step_negative", "A negative grid_step.", dict(grid_step=struct.pack("<f", -1))),
            ("mesh_flags", "A reserved bit of REFM.", dict(flags=b"\x80")),
            ("coded_mesh_flags", "A reserved bit of the coded mesh.", dict(mesh_flags=b"\x80")),
            ("no_vertices", "vertex_count 0.", dict(vertex_count=0)),
            ("vertices_beyond_bytes", "More vertices than the mesh's bytes can hold.", dict(vertex_count=1 << 20)),
            ("faces_beyond_bytes", "More faces than the mesh's bytes can hold.", dict(face_count=1 << 20)),
            ("wrong_shot", "A shot that is not announced.", dict(shot=1)),
            ("late_shot", "A first_frame behind a gap.", dict(first_frame=1))):
        m.add(name, "corrupt", sentence, file.edited(b"REFM", **changes))
    m.add("too_many_vertices", "limit exceeded", "2^25 vertices, more than a decoder need allow.",
          file.edited(b"REFM", vertex_count=1 << 25))
    m.add("too_many_faces", "limit exceeded", "2^32 - 1 faces, more than a decoder need allow.",
          file.edited(b"REFM", face_count=UINT32))
    for name, sentence, changes in (
            ("no_group_frames", "A group of no frames.", dict(frame_count=0)),
            ("group_past_end", "A group past the end of the sequence.", dict(frame_count=16)),
            ("wrong_profile", "An unknown profile.", dict(profile=b"\x7F")),
            ("next_profile", "The profile behind the last.", dict(profile=b"\4")),
            ("step_zero", "quantization_step 0.", dict(quantization_step=bytes(4))),
            ("step_not_a_number", "A quantization_step that is no number.", dict(quantization_step=nan)),
            ("group_flags", "A reserved bit of GRUP.", dict(flags=b"\x80")),
            ("section_too_long", "A section longer than its chunk.", dict(basis_bytes=1 << 20)),
            ("section_too_short", "Bytes behind the last section.", dict(basis_bytes=1)),
            ("group_of_other_shot", "A group of a shot that is not there.", dict(shot=3))):
        m.add(name, "corrupt", sentence, file.edited(b"GRUP", **changes))
    for name, sentence, changes in (
            ("too_many_components", "More components than coordinates; the other groups decode.",
             dict(component_count=13)),
            ("too_many_regions", "1025 regions; the other groups decode.", dict(region_count=1025)),
            ("motion_not_used", "A motion section where no region is.", dict(motion=b"\1\2\3"))):
        m.add(name, "corrupt", sentence, file.edited(b"GRUP", **changes))
    m.add("beyond_components", "corrupt", "3 * 2^16 + 1 components, which no group has: the file is refused.",
          file.edited(b"GRUP", component_count=3 * 65536 + 1))
    mixed = File(m.sound("profiles_mixed"))
    for name, sentence, which, changes in (
            ("one_of_wrong_components", "Two groups of three decode beside one of the thesis profile with too few components.",
             0, dict(component_count=5)),
            ("one_with_basis", "The same beside one with a basis.", 0, dict(basis=b"\1")),
            ("one_continues", "The same beside one that continues another profile.", 2, dict(flags=b"\1")),
            ("one_is_weak", "The same beside one of a weak prior.", 2, dict(flags=b"\x08"))):
        m.add(name, "corrupt", sentence, mixed.edited(b"GRUP", which, **changes))
    for name, section, sentence in (
            ("planes_beyond_bytes", "coefficients", "Planes of more values than the group's bytes can hold."),
            ("frames_beyond_bytes", "differences", "Coded frames of more coordinates than the group's bytes can hold.")):
        full = File(m.sound({"coefficients": "full_planes", "differences": "lossless_full"}[section]))
        zeros = read_group(full.chunks[2][1])[section]
        m.add(name, "corrupt", sentence, full.edited(b"GRUP", **{section: zeros[:-2]}))
    many = File(m.sound("one_vertex"))
    m.add("corrections_beyond_bytes", "corrupt", "More corrections than the group's bytes can hold, whose section is not read.",
          many.edited(b"GRUP", flags=b"\2" + f64(1.0) + uv(1 << 20) + uv(0)))
    exact = File(m.sound("lossless_shots"))
    m.add("one_lossless_of_none", "corrupt", "A lossless group of no coded frames; the others decode.",
          exact.edited(b"GRUP", 1, stored_count=0))
    m.add("one_lossless_of_more", "corrupt", "A lossless group of more coded frames than frames; the others decode.",
          exact.edited(b"GRUP", 1, stored_count=4))
    shots = File(m.sound("shots"))
    second = read_reference(shots.chunks[shots.places(b"REFM")[1]][1])
    m.add("one_mesh_flags", "corrupt", "A reserved bit of the second of three coded meshes: the file is refused.",
          shots.edited(b"REFM", 1, mesh_flags=b"\x80"))
    m.add("one_mesh_not_filled", "corrupt", "Bytes behind the sections of the second of three meshes: its shot is lost.",
          shots.edited(b"REFM", 1, order=second["order"] + b"\0", order_bytes=len(second["order"])))
    thesis = File(m.sound("thesis"))
    m.add("thesis_components", "corrupt", "A thesis group with too few components.",
          thesis.edited(b"GRUP", component_count=14))
    m.add("thesis_basis", "corrupt", "A thesis group with a basis.", thesis.edited(b"GRUP", basis=b"\1"))


def add_sections(m):
    """Range codes and meshes that break off or say what cannot be."""
    file = File(m.sound("groups"))
    group = read_group(file.chunks[2][1])
    m.add("short_coefficients", "corrupt", "Half of the first group's coefficients; the other groups decode.",
          file.edited(b"GRUP", coefficients=group["coefficients"][:len(group["coefficients"]) // 2]))
    m.add("no_basis", "corrupt", "An empty basis section; the other groups decode.", file.edited(b"GRUP", basis=b""))
    m.add("basis_out_of_range", "corrupt", "A mean that is infinite; the other groups decode.",
          file.edited(b"GRUP", basis=bytes(2000), quantization_step=b"\xFF\xFF\x7F\x7F"))
    mesh = read_reference(file.chunks[1][1])
    m.add("short_rest", "corrupt", "Half of the section rest.",
          file.edited(b"REFM", rest=mesh["rest"][:len(mesh["rest"]) // 2]))
    m.add("short_order", "corrupt", "An empty section order.", file.edited(b"REFM", order=b""))
    m.add("order_not_used", "corrupt", "A section order where none is kept.", file.edited(b"REFM", mesh_flags=b"\0"))
    m.add("mesh_not_filled", "corrupt", "Bytes behind the sections of the mesh.",
          file.edited(b"REFM", order=mesh["order"] + b"\0", order_bytes=len(mesh["order"])))
    m.add("fewer_vertices", "corrupt", "More points than vertices.", file.edited(b"REFM", vertex_count=20))
    m.add("fewer_faces", "corrupt", "More polygons than faces.", file.edited(b"REFM", face_count=3))
    m.add("draco_damaged", "corrupt", "Symbols that make no surface.",
          file.edited(b"REFM", draco=mesh["draco"][:8] + bytes(len(mesh["draco"]) - 8)))
    m.add("draco_traversal", "corrupt", "An unknown traversal.", file.edited(b"REFM", draco=b"\1" + mesh["draco"][1:]))
    m.add("draco_counts", "corrupt", "More triangles than the mesh's bytes can hold.",
          file.edited(b"REFM", draco=mesh["draco"][:1] + uv(1 << 20) + uv(1 << 20) + mesh["draco"][3:]))
    for name, section in (("noise", "coefficients"), ("noise", "basis"), ("thesis_noise", "coefficients")):
        sound = File(m.sound(name))
        cut = read_group(sound.chunks[2][1])[section][:-1]
        m.add("%s_without_end_of_%s" % (name, section), "corrupt", "A range code that is one byte short: it is read past its end.",
              sound.edited(b"GRUP", **{section: cut}))
    regions = File(m.sound("main_regions"))
    m.add("region_out_of_range", "corrupt", "A region that is not there.", regions.edited(b"GRUP", motion=bytes(400)))
    m.add("no_motion", "corrupt", "An empty motion section.", regions.edited(b"GRUP", motion=b""))
    chain = File(m.sound("open_groups"))
    at = chain.offsets()
    m.add("first_continues", "corrupt", "The first group continues one; those after it continue it.",
          chain.edited(b"GRUP", flags=b"\1"))
    m.add("broken_run", "corrupt", "The second of four groups is lost, and with it those that continue it.",
          flipped(chain.pack(), at[3] + 30))
    m.add("other_profile_continues", "corrupt", "A group continues one of another profile.",
          chain.edited(b"GRUP", 1, profile=b"\1"))
    m.add("continues_weak_prior", "corrupt", "A group that continues another has a weak prior.",
          chain.edited(b"GRUP", 1, flags=b"\x09"))
    m.add("thesis_weak_prior", "corrupt", "A group of the thesis profile has a weak prior.",
          File(m.sound("thesis")).edited(b"GRUP", flags=b"\x08"))
    m.add("thesis_continues", "corrupt", "A group of the thesis profile continues one.",
          File(m.sound("thesis")).edited(b"GRUP", flags=b"\1"))
    longest = File(m.sound("longest_run"))
    m.add("run_too_long", "corrupt", "64 groups that continue the one before: the last is lost.",
          longest.edited(b"GRUP", 64, flags=b"\1"))
    bounded = File(m.sound("corrections"))
    corrected = read_group(bounded.chunks[2][1])
    for name, sentence, changes in (
            ("too_few_corrections", "A correction more than correction_count.",
             dict(correction_count=corrected["correction_count"] - 1)),
            ("too_many_corrections", "A correction less than correction_count.",
             dict(correction_count=corrected["correction_count"] + 1)),
            ("endless_corrections", "More corrections than coordinates.", dict(correction_count=3 * 72 * 5 + 1)),
            ("correction_step_zero", "correction_step 0.", dict(correction_step=f64(0.0))),
            ("short_corrections", "Half of the corrections.",
             dict(corrections=corrected["corrections"][:len(corrected["corrections"]) // 2]))):
        m.add(name, "corrupt", sentence, bounded.edited(b"GRUP", **changes))
    exact = File(m.sound("lossless"))
    h = read_group(exact.chunks[2][1])
    raw = h["raw"]
    for name, sentence, changes in (
            ("lossless_more_frames", "More coded frames than stored_count.", dict(stored_count=5)),
            ("lossless_no_frames", "A lossless group with stored_count 0.", dict(stored_count=0)),
            ("lossless_flags", "A lossless group with a flag.", dict(flags=b"\2")),
            ("lossless_digits", "A set of ten digits.", dict(raw=bytes([raw[0] & 0xF0 | 10]) + raw[1:])),
            ("lossless_short_raw", "Raw bits that end early.", dict(raw=raw[:len(raw) // 2])),
            ("lossless_long_raw", "A byte of raw bits too many.", dict(raw=raw + b"\0")),
            ("lossless_short_code", "Half of the range code.",
             dict(differences=h["differences"][:len(h["differences"]) // 2])),
            ("lossless_distance", "A copy of a frame before the group.", dict(differences=bytes(8)))):
        m.add(name, "corrupt", sentence, exact.edited(b"GRUP", **changes))
    grids = File(m.sound("lossless_grids"))
    raw = read_group(grids.chunks[2][1])["raw"]
    # Of the first axis, behind 12 bits of sets: 16 of levels, 64 of origin, 64 of step.
    for name, sentence, changes in (
            ("lossless_grid_origin", "A grid whose origin is no number.", dict(raw=with_bits(raw, 28, 64, -1))),
            ("lossless_grid_step", "A grid whose step is 0.", dict(raw=with_bits(raw, 92, 64, 0))),
            ("lossless_grid_levels", "Corrections of levels that a grid does not have.",
             dict(raw=with_bits(raw, 12, 16, 2)))):
        m.add(name, "corrupt", sentence, grids.edited(b"GRUP", **changes))
    fast = File(m.sound("fast_order"))
    plain = read_reference(fast.chunks[1][1])
    position, order = plain["position"], plain["order"]
    for name, sentence, changes in (
            ("plain_short_positions", "Half of the positions of a plain mesh.",
             dict(position=position[:len(position) // 4 * 2])),
            ("plain_no_positions", "A plain mesh without positions.", dict(position=b"")),
            ("plain_half_word", "Half a word at the end of a lane section.", dict(position=position + b"\0")),
            ("plain_long_tables", "Tables longer than their section.", dict(position=b"\xFF" * 4 + position[4:])),
            ("plain_frequencies", "Frequencies that sum up to more than 1024.",
             dict(position=struct.pack("<II", 100, 0) + bytes(100) + position[8:])),
            ("plain_short_order", "Half of the order of a plain mesh.", dict(order=order[:len(order) // 4 * 2]))):
        m.add(name, "corrupt", sentence, fast.edited(b"REFM", **changes))
    h = read_group(fast.chunks[2][1])
    m.add("fast_short_coefficients", "corrupt", "Half of a coefficient section of the fast profile.",
          fast.edited(b"GRUP", coefficients=h["coefficients"][:len(h["coefficients"]) // 4 * 2]))
    m.add("fast_no_basis", "corrupt", "No basis section in the fast profile.", fast.edited(b"GRUP", basis=b""))
    m.add("main_on_plain_mesh", "corrupt", "A group of the main profile on a plain mesh.",
          fast.edited(b"GRUP", profile=b"\0"))
    listed = File(m.sound("listed_faces"))
    rest = read_reference(listed.chunks[1][1])["rest"]
    m.add("corner_out_of_range", "corrupt", "A listed face with a vertex that is not there.",
          listed.edited(b"REFM", rest=rest[:len(rest) // 2] + bytes(2 * len(rest))))


def generate(folder):
    m = Maker(pathlib.Path(folder))
    for add in (add_ends, add_checksums, add_containers, add_headers, add_sections):
        add(m)
    return m.made
