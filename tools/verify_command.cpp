#include <memory>

#include "bitstream/container.h"
#include "codec/dec/decoder.h"
#include "tools/command.h"
#include "tools/damage.h"
#include "tools/io/file_bytes.h"
#include "tools/io/read_sequence.h"
#include "tools/text.h"

namespace reeb::tools {
namespace verify_command {
namespace {

struct Options {
  std::vector<std::string> inputs;
  unsigned threads = 0;
  uint64_t max_memory = Limits().max_memory;
  ConsoleOptions console;
};

/// What is wrong with one file, by sentences; decodes all of it.
Status check(const std::string& name, const Options& o, Console& console,
             std::vector<std::string>& faults) {
  FileBytes file;
  if (Status status = FileBytes::read(name, file); !status.ok()) return status;
  const std::string_view text = file.view();
  const std::span<const uint8_t> bytes(reinterpret_cast<const uint8_t*>(text.data()), text.size());
  ContainerReader container;
  std::unique_ptr<Decoder> decoder;
  DecodeOptions options{.limits = {}, .threads = o.threads};
  options.limits.max_memory = o.max_memory;
  Status status = container.parse(bytes, options.limits);
  if (status.ok()) status = Decoder::open(bytes, options, decoder);
  std::vector<StreamInfo::Gap> missing;
  if (status.ok()) status = find_missing(*decoder, console.bar("checking"), missing);
  if (!status.ok()) return stream_failure(name, status, o.max_memory);
  const StreamInfo& info = decoder->info();
  for (const DamagedRange& range : container.damaged)
    faults.push_back(name + ": " + describe(range));
  if (info.truncated) faults.push_back(name + ": truncated, the end of the file is missing");
  if (!missing.empty()) faults.push_back(describe_missing(name, missing, info.total_frames));
  if (faults.empty())
    console.say(name + ": good, " + counted(info.total_frames, "frame") + " in " +
                counted(info.groups.size(), "group"));
  return {};
}

int run(const Options& o) {
  Console console(o.console);
  int exit_code = kExitDone;
  for (const std::string& name : o.inputs) {
    std::vector<std::string> faults;
    const Status status = check(name, o, console, faults);
    if (!status.ok()) faults.push_back(status.message());
    for (const std::string& fault : faults) console.error(fault);
    if (!faults.empty()) exit_code = kExitFailed;
  }
  return exit_code;
}

}  // namespace
}  // namespace verify_command

void add_verify_command(CLI::App& app, int& exit_code) {
  using namespace verify_command;
  auto* command = app.add_subcommand("verify", "Decode .reeb files to see whether they are whole");
  auto o = std::make_shared<Options>();
  command->add_option("FILE", o->inputs, "The .reeb files; - = standard input")
      ->required()
      ->type_name("");
  add_threads_option(*command, o->threads);
  add_memory_limit_option(*command, o->max_memory);
  add_console_options(*command, o->console);
  command->callback([o, &exit_code] { exit_code = run(*o); });
}

}  // namespace reeb::tools
