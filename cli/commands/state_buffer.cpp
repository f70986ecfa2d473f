// The buffers that a draw reads, and what stands in one.
#include <iostream>

#include "cli/commands/state.h"
#include "profiler/pictures/files.h"
#include "session/buffers.h"

namespace shadestep::cli {
namespace {

using session::BoundBuffer;
using session::BufferContents;
using session::BufferUse;
using session::ElementFormat;

constexpr std::uint64_t kMostInText = 32;  // elements

std::string nameOf(const BoundBuffer& buffer) {
  return buffer.name.empty() ? session::useName(buffer.use) : buffer.name;
}

BoundBuffer found(session::Session& session, const std::string& name) {
  std::string there;
  for (BoundBuffer& buffer : session.buffers()) {
    if (nameOf(buffer) == name) return std::move(buffer);
    there += (there.empty() ? "" : ", ") + nameOf(buffer);
  }
  throw session::Error(session::Outcome::nothing_matches,
                       "this draw reads no buffer as '" + name + "'; " +
                           (there.empty() ? "it reads none" : "there are " + there));
}

// Rows of a table: members of a block, or else elements.
struct Table {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

Table tableOf(const BoundBuffer& buffer, const BufferContents& contents) {
  if (!buffer.members.empty()) {
    Table table{{"name", "type", "offset", "value"}, {}};
    for (const session::MemberValue& member : contents.values.members)
      table.rows.push_back({member.name, member.type, std::to_string(member.offset), member.value});
    return table;
  }
  const ElementFormat format = session::formatOf(buffer);
  Table table{{"element"}, {}};
  for (int c = 0; c < format.components; ++c) table.header.push_back(std::string(1, "xyzw"[c]));
  const std::uint64_t count = format.count(contents.bytes.size());
  for (std::uint64_t i = 0; i < count; ++i) {
    std::vector<std::string>& row = table.rows.emplace_back(1, std::to_string(i));
    for (int c = 0; c < format.components; ++c)
      row.push_back(session::elementText(format, contents.bytes, i, c));
  }
  return table;
}

std::string asCsv(const Table& table) {
  std::string csv;
  const auto add = [&](const std::vector<std::string>& row) {
    for (std::size_t i = 0; i < row.size(); ++i) csv += (i > 0 ? "," : "") + session::csvCell(row[i]);
    csv += "\n";
  };
  add(table.header);
  for (const auto& row : table.rows) add(row);
  return csv;
}

Json asJson(const BoundBuffer& buffer, const BufferContents& contents, const Table& table) {
  Json document = cli::asJson(buffer);
  document["rows"] = Json::array();
  for (const auto& row : table.rows) {
    Json one = Json::object();
    for (std::size_t i = 0; i < row.size(); ++i) one[table.header[i]] = row[i];
    document["rows"].push_back(std::move(one));
  }
  document["left_out"] = contents.values.left_out;
  document["check"] = toJson(contents.check);
  return document;
}

void printText(const BoundBuffer& buffer, const BufferContents& contents, const Table& table) {
  std::cout << cli::asText(buffer) << "\n";
  for (std::size_t i = 0; i < table.rows.size() && i < kMostInText; ++i) {
    const std::vector<std::string>& row = table.rows[i];
    if (!buffer.members.empty()) {
      std::cout << "  " << row[2] << ": " << row[1] << " " << row[0] << " = " << row[3] << "\n";
      continue;
    }
    std::cout << "  " << row[0] << ":";
    for (std::size_t c = 1; c < row.size(); ++c) std::cout << " " << row[c];
    std::cout << "\n";
  }
  if (table.rows.size() + contents.values.left_out > kMostInText)
    std::cout << "  ... " << withThousands(table.rows.size() + contents.values.left_out)
              << " in all; --csv F and --json give " << withThousands(table.rows.size()) << "\n";
  if (!contents.check.compared_at_all)
    std::cout << "not compared: " << contents.check.reason << "\n";
  else if (contents.check.identical())
    std::cout << "the draw leaves it as it is\n";
  else
    std::cout << "the draw itself changes " << withThousands(contents.check.differing)
              << " of these bytes: this is what stands there before it\n";
}

}  // namespace

Json asJson(const BoundBuffer& buffer) {
  return {{"use", session::useName(buffer.use)},
          {"name", buffer.name.empty() ? Json(nullptr) : Json(buffer.name)},
          {"index", buffer.index},
          {"buffer", buffer.buffer},
          {"offset", buffer.offset},
          {"bytes", buffer.bytes},
          {"reason", buffer.reason.empty() ? Json(nullptr) : Json(buffer.reason)}};
}

std::string asText(const BoundBuffer& buffer) {
  std::string text = session::useName(buffer.use);
  if (!buffer.name.empty()) text += " " + buffer.name;
  if (buffer.use != BufferUse::indices && buffer.use != BufferUse::commands)
    text += " at " + std::to_string(buffer.index);
  if (!buffer.reason.empty()) return text + ": " + buffer.reason;
  return text + ": buffer " + std::to_string(buffer.buffer) + ", " + withThousands(buffer.bytes) +
         " bytes from " + withThousands(buffer.offset) + " on";
}

int showBuffer(session::Session& session, const Common& common, const StateOptions& options) {
  if (!options.image.empty())
    throw session::Error(session::Outcome::usage, "--image shows texels; take --csv F for a buffer");
  const BoundBuffer buffer = found(session, options.buffer);
  if (!buffer.reason.empty())
    throw session::Error(session::Outcome::cannot_debug,
                         "the buffer of '" + options.buffer + "' cannot be read: " + buffer.reason);
  const BufferContents contents = session::bufferContents(session, buffer);
  const Table table = tableOf(buffer, contents);
  if (!options.csv.empty()) profiler::writeFile(common.inOut(options.csv), asCsv(table));
  if (common.json)
    print(asJson(buffer, contents, table));
  else
    printText(buffer, contents, table);
  return 0;
}

}  // namespace shadestep::cli
