#include "shader_case.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

namespace shadestep::test {
namespace {

constexpr int kX = 5, kY = 7;  // the recorded pixel

int lastLine(const std::string& shader) {
  return 1 + static_cast<int>(std::count(
                 shader.begin(), shader.begin() + static_cast<std::ptrdiff_t>(shader.find("//LAST")), '\n'));
}

double number(const std::string& cell) {
  return cell == "true" ? 1 : cell == "false" ? 0 : std::stod(cell);
}

double number(const Json& value) {
  return value.is_boolean() ? (value.get<bool>() ? 1 : 0) : value.get<double>();
}

std::vector<std::string> commandOf(const Scratch& scratch, const std::string& shader,
                                   const std::string& program) {
  std::ofstream(scratch.file("shader.frag")) << shader;
  return {binary("programs/" + program), scratch.file("shader.frag")};
}

void expectRows(const ShaderCase& one, const Scratch& scratch) {
  const auto rows = readCsv(scratch.file("values.csv"));
  ASSERT_EQ(rows.size(), 256u);
  for (const auto& row : rows) {
    const auto expected = one.expected(std::stoi(row[0]), std::stoi(row[1]));
    ASSERT_EQ(row.size(), expected.size() + 2);
    for (std::size_t i = 0; i < expected.size(); ++i)
      ASSERT_EQ(number(row[i + 2]), expected[i]) << one.watches[i] << " at " << row[0] << "," << row[1];
  }
}

void expectLastValues(const ShaderCase& one, const Json& steps) {
  const auto expected = one.expected(kX, kY);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    Json last;
    for (const Json& step : steps) {
      if (step["changed"].contains(one.watches[i]))
        last = step["changed"][one.watches[i]]["value"];
    }
    if (last.is_null()) continue;  // a part of a variable
    EXPECT_EQ(number(last), expected[i]) << one.watches[i];
  }
}

}  // namespace

Json stepsOf(const Scratch& scratch, const std::string& shader, const std::string& program,
             const std::string& pixel) {
  const Finished run =
      scratch.shadestep({"debug", "--pixel", pixel, "--json"}, commandOf(scratch, shader, program));
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.json()["check"]["outputs"], "identical");
  return run.json()["steps"];
}

void expectValuesOf(const ShaderCase& one, const std::string& program) {
  const Scratch scratch;
  const std::vector<std::string> command = commandOf(scratch, one.shader, program);
  std::string watches;
  for (const std::string& watch : one.watches) watches += (watches.empty() ? "" : ",") + watch;

  const Finished alone = scratch.run(command);
  ASSERT_EQ(alone.status, 0) << alone.err;
  const Finished all = scratch.shadestep({"debug", "--at", std::to_string(lastLine(one.shader)), "--print",
                                          watches, "--csv", "values.csv", "--json", "--continue"},
                                         command);
  ASSERT_EQ(all.status, 0) << all.err;
  EXPECT_EQ(all.json()["check"]["outputs"], "identical");
  EXPECT_NE(all.err.find(alone.out), std::string::npos)
      << "alone: " << alone.out << "under debug: " << all.err;
  expectRows(one, scratch);
  expectLastValues(one, stepsOf(scratch, one.shader, program, std::to_string(kX) + "," + std::to_string(kY)));
}

}  // namespace shadestep::test
