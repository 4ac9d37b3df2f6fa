#include <algorithm>
#include <memory>
#include <sstream>

#include "bitstream/container.h"
#include "codec/dec/decoder.h"
#include "tools/attribute_text.h"
#include "tools/command.h"
#include "tools/damage.h"
#include "tools/encoding_report.h"
#include "tools/io/file_bytes.h"
#include "tools/json.h"
#include "tools/text.h"

namespace reeb::tools {
namespace info_command {
namespace {

struct Options {
  std::vector<std::string> inputs;
  bool keep_going = false;
  bool json = false;
  bool trace = false;
  ConsoleOptions console;
};

double bits_per_vertex_and_frame(const StreamInfo& info) {
  double n = 0;
  for (const auto& shot : info.shots) n += double{1} * shot.vertex_count * shot.frame_count;
  return n > 0 ? 8 * static_cast<double>(info.file_bytes) / n : 0;
}

const char* name_of(Profile profile) {
  switch (profile) {
    case Profile::kMain:
      return "main";
    case Profile::kFast:
      return "fast";
    case Profile::kThesis:
      return "thesis";
    case Profile::kLossless:
      return "lossless";
  }
  return "";
}

/// Of the groups, each once.
std::vector<std::string> profiles_of(const StreamInfo& info) {
  std::vector<std::string> out;
  for (const auto& g : info.groups) {
    const char* const name = name_of(g.profile);
    if (std::find(out.begin(), out.end(), name) == out.end()) out.emplace_back(name);
  }
  return out;
}

/// Around all groups; false where the file does not tell.
bool box_of(const StreamInfo& info, Box& out) {
  if (info.bounds.empty()) return false;
  out = info.bounds.front();
  for (const Box& box : info.bounds) {
    for (size_t i = 0; i < 3; ++i) {
      out.low[i] = std::min(out.low[i], box.low[i]);
      out.high[i] = std::max(out.high[i], box.high[i]);
    }
  }
  return true;
}

bool report_of(const StreamInfo& info, EncodingReport& out) {
  return std::any_of(info.metadata.begin(), info.metadata.end(), [&](const auto& entry) {
    return entry.first == kReportKey && parse_report(entry.second, out);
  });
}

Json to_json(const Box& box) { return {{"low", box.low}, {"high", box.high}}; }

/// How the file was made and where it lies, as far as it tells.
void add_report(const StreamInfo& info, Json& json) {
  json["profiles"] = profiles_of(info);
  Box box;
  json["box"] = box_of(info, box) ? to_json(box) : Json();
  EncodingReport report;
  const bool told = report_of(info, report);
  json["target"] = told ? Json{{"kind", report.target}, {"value", report.wanted}} : Json();
  json["error"] =
      told ? Json{{"kg", report.kg}, {"rmse", report.rmse}, {"max_error", report.max_error}}
           : Json();
}

std::string time_of(const AttributeHeader& h) {
  if (h.computed()) return "computed";
  return h.animated() ? "animated" : "static";
}

void add_attributes(const StreamInfo& info, Json& json) {
  json["attributes"] = Json::array();
  for (const auto& a : info.attributes) {
    json["attributes"].push_back({{"shot", a.header.shot + 1},
                                  {"name", a.header.name},
                                  {"semantic", to_string(a.header.semantic)},
                                  {"domain", to_string(a.header.domain)},
                                  {"type", to_string(a.header.type)},
                                  {"channels", a.header.channel_count},
                                  {"time", time_of(a.header)},
                                  {"bytes", a.bytes}});
  }
  json["resources"] = Json::array();
  for (const auto& r : info.resources) {
    json["resources"].push_back(
        {{"name", r.header.name}, {"media_type", r.header.media_type}, {"bytes", r.bytes}});
  }
}

Json to_json(const std::string& name, const StreamInfo& info) {
  Json json{{"file", name},
            {"format_version", info.format_version},
            {"bytes", info.file_bytes},
            {"bpvf", bits_per_vertex_and_frame(info)},
            {"frames", info.frame_count},
            {"frame_rate", info.frame_rate},
            {"start_time", info.start_time},
            {"total_frames", info.total_frames},
            {"truncated", info.truncated},
            {"missing", Json::array()},
            {"shots", Json::array()},
            {"groups", Json::array()},
            {"sections", Json::object()},
            {"metadata", Json::object()}};
  for (const auto& s : info.shots) {
    json["shots"].push_back({{"first_frame", s.first_frame + 1},
                             {"frames", s.frame_count},
                             {"vertices", s.vertex_count},
                             {"faces", s.face_count},
                             {"order_kept", s.order_kept}});
  }
  for (const auto& g : info.groups) {
    json["groups"].push_back({{"first_frame", g.first_frame + 1},
                              {"frames", g.frame_count},
                              {"shot", g.shot + 1},
                              {"regions", g.region_count},
                              {"components", g.component_count},
                              {"bytes", g.bytes},
                              {"continues", g.continues},
                              {"profile", name_of(g.profile)},
                              {"lossless", g.profile == Profile::kLossless}});
  }
  for (size_t g = 0; g < info.bounds.size(); ++g)
    json["groups"][g]["box"] = to_json(info.bounds[g]);
  add_report(info, json);
  add_attributes(info, json);
  for (const auto& gap : info.missing)
    json["missing"].push_back({{"first_frame", gap.first_frame + 1}, {"frames", gap.frame_count}});
  for (const auto& s : info.sections) json["sections"][s.name] = s.bytes;
  for (const auto& [key, value] : info.metadata) json["metadata"][key] = value;
  return json;
}

std::string target_text(const EncodingReport& report) {
  const std::string value = plain(report.wanted, 9);
  if (report.target == "kg") return "KG " + value + " %";
  if (report.target == "max-error") return "no coordinate further off than " + value;
  if (report.target == "bpvf") return value + " bits per vertex and frame";
  return report.target == "size" ? grouped(static_cast<uint64_t>(report.wanted)) + " bytes"
                                 : report.target;
}

std::string point_text(const float* xyz) {
  return "(" + plain(xyz[0]) + ", " + plain(xyz[1]) + ", " + plain(xyz[2]) + ")";
}

void print_report(const StreamInfo& info, std::ostream& out) {
  const std::vector<std::string> profiles = profiles_of(info);
  for (size_t i = 0; i < profiles.size(); ++i) out << (i > 0 ? ", " : "") << profiles[i];
  if (!profiles.empty()) out << " profile";
  EncodingReport report;
  if (report_of(info, report)) {
    out << ", target: " << target_text(report) << "\nerror when encoded: KG " << plain(report.kg)
        << " %, RMSE " << plain(report.rmse) << ", maximum " << plain(report.max_error);
  }
  out << "\n";
  Box box;
  if (box_of(info, box))
    out << "within " << point_text(box.low) << " to " << point_text(box.high) << "\n";
}

/// Names of attributes and files are of foreign origin.
std::string printable(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return text;
}

void print_attributes(const StreamInfo& info, std::ostream& out) {
  if (!info.attributes.empty()) out << counted(info.attributes.size(), "attribute") << "\n";
  for (const auto& a : info.attributes) {
    const AttributeHeader& h = a.header;
    out << "  " << printable(h.name) << ": " << to_string(h.semantic) << " of each "
        << to_string(h.domain) << ", " << h.channel_count << " x " << to_string(h.type) << ", "
        << time_of(h) << ", " << byte_size(a.bytes);
    if (info.shots.size() > 1) out << ", shot " << grouped(uint64_t{h.shot} + 1);
    out << "\n";
  }
  if (!info.resources.empty()) out << counted(info.resources.size(), "file") << "\n";
  for (const auto& r : info.resources) {
    out << "  " << printable(r.header.name) << ": " << printable(r.header.media_type) << ", "
        << byte_size(r.bytes) << "\n";
  }
}

void print_text(const std::string& name, const StreamInfo& info, std::ostream& out) {
  out << name << ": reeb format " << info.format_version << ", " << byte_size(info.file_bytes)
      << ", " << plain(bits_per_vertex_and_frame(info)) << " bits per vertex and frame"
      << (info.truncated ? ", truncated" : "") << "\n";
  out << counted(info.frame_count, "frame");
  if (info.frame_rate > 0) out << " at " << plain(info.frame_rate, 6) << " per second";
  if (info.start_time != 0) out << ", from time " << plain(info.start_time, 6);
  out << "\n";
  print_report(info, out);
  for (const auto& s : info.shots) {
    out << "from frame " << grouped(s.first_frame + 1) << ": " << counted(s.frame_count, "frame")
        << " of " << counted(s.vertex_count, "vertex") << ", " << counted(s.face_count, "face")
        << (s.order_kept ? "" : ", vertices reordered") << "\n";
  }
  for (const auto& gap : info.missing) {
    out << "frames " << grouped(gap.first_frame + 1) << " to "
        << grouped(gap.first_frame + gap.frame_count) << " are damaged or cut off\n";
  }
  out << counted(info.groups.size(), "group") << "\n";
  for (const auto& g : info.groups) {
    out << "  frames " << grouped(g.first_frame + 1) << " to "
        << grouped(g.first_frame + g.frame_count) << ": ";
    if (g.profile == Profile::kLossless) {
      out << "lossless, " << counted(g.stored_count, "coded frame");
    } else {
      out << counted(g.component_count, "component") << ", " << counted(g.region_count, "region");
    }
    out << ", " << byte_size(g.bytes) << (g.continues ? ", continues the group before" : "")
        << "\n";
  }
  print_attributes(info, out);
  for (const auto& s : info.sections) out << "  " << s.name << ": " << byte_size(s.bytes) << "\n";
  EncodingReport told;
  for (const auto& [key, value] : info.metadata) {
    if (key != kReportKey || !parse_report(value, told))
      out << "  " << key << " = " << value << "\n";
  }
}

/// What a file holds goes to `text` or `json`; what it lacks is said. Gives the exit code.
int show(const Options& o, const std::string& name, Console& console, std::ostream& text,
         Json& json) {
  FileBytes file;
  Status status = FileBytes::read(name, file);
  if (!status.ok()) return fail(console, status);
  const std::string_view view = file.view();
  const std::span<const uint8_t> bytes(reinterpret_cast<const uint8_t*>(view.data()), view.size());
  if (o.trace) {
    text << trace(bytes);
    return kExitDone;
  }
  std::unique_ptr<Decoder> decoder;
  status = Decoder::open(bytes, {}, decoder);
  if (!status.ok()) return fail(console, {status.code(), name + ": " + status.message()});
  const StreamInfo& info = decoder->info();
  if (o.json) {
    json.push_back(to_json(name, info));
  } else {
    print_text(name, info, text);
  }
  return finish_damaged(console, describe_damage(name, info, info.missing), o.keep_going);
}

int run(const Options& o) {
  Console console(o.console);
  std::ostringstream text;
  Json json = Json::array();
  int exit_code = kExitDone;
  for (const std::string& name : o.inputs) {
    if (name != o.inputs.front() && !o.json) text << "\n";
    exit_code = std::max(exit_code, show(o, name, console, text, json));
  }
  if (o.json && !json.empty()) text << dump(o.inputs.size() == 1 ? json.front() : json);
  return std::max(exit_code, print(text.str(), console));
}

}  // namespace
}  // namespace info_command

void add_info_command(CLI::App& app, int& exit_code) {
  using namespace info_command;
  auto* command = app.add_subcommand("info", "Show what .reeb files hold");
  auto o = std::make_shared<Options>();
  command->add_option("FILE", o->inputs, "The .reeb files; - = standard input")
      ->required()
      ->type_name("");
  auto* json = command->add_flag("--json", o->json, "As JSON");
  command->add_flag("--trace", o->trace, "Every field of every header instead, damaged files too")
      ->excludes(json);
  add_keep_going_option(*command, o->keep_going);
  add_console_options(*command, o->console);
  command->callback([o, &exit_code] { exit_code = run(*o); });
}

}  // namespace reeb::tools
