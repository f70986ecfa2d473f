// Before which places a variable has got no value: by hand, and by walking all ways through a shader.
#include "session/written.h"

#include <gtest/gtest.h>

#include <set>

namespace shadestep::session {
namespace {

class Walker {
 public:
  explicit Walker(const std::string& body)
      : analysis_(frontend::analyse(
            frontend::Stage::fragment,
            {"#version 330 core\nout vec4 o;\nuniform int u;\nfloat g;\nfloat h = 1.0;\n" + body}, {})) {
    EXPECT_TRUE(analysis_.shader) << analysis_.error;
  }
  const frontend::Shader& shader() const { return *analysis_.shader; }

  // The lines (of the body, from 1) at whose first visit the variable is said to be unwritten.
  std::set<int> unwritten(const std::string& name) {
    std::set<int> lines, seen;
    forAllPlaces([&](const Position& position, bool) {
      const frontend::Statement& at = shader().statements[static_cast<std::size_t>(position.statement)];
      const int line = at.place.line - 5;
      if (!seen.insert(line).second) return;
      const auto watch = frontend::resolveWatch(shader(), position.statement, name).watch;
      if (watch && !mayBeWritten(shader(), position, *watch)) lines.insert(line);
    });
    return lines;
  }

  // Visits what can be reached by single steps, every call stepped into, loops up to their third iteration;
  // with what the statements on this way have changed of the variable.
  void forAllPlaces(const std::function<void(const Position&, bool written)>& visit,
                    frontend::VariableId variable = frontend::kNone) {
    const Navigation navigation(shader());
    std::vector<std::pair<Position, bool>> ahead = {{navigation.start(), false}};
    std::vector<std::pair<Position, bool>> done;
    for (std::size_t i = 0; i < ahead.size(); ++i) {
      const auto [position, written] = ahead[i];
      if (position.ended() || std::find(done.begin(), done.end(), ahead[i]) != done.end()) continue;
      done.push_back(ahead[i]);
      visit(position, written);
      if (position.condition) {
        for (const Side& side : navigation.sides(position))
          if (side.next.iterations.empty() || side.next.iterations.back() < 3)
            ahead.emplace_back(side.next, written);
        continue;
      }
      const frontend::Statement& at = shader().statements[static_cast<std::size_t>(position.statement)];
      const auto has = [&](const std::vector<frontend::VariableId>& list) {
        return std::find(list.begin(), list.end(), variable) != list.end();
      };
      const bool increments = !position.iterations.empty() && position.iterations.back() > 0;
      ahead.emplace_back(navigation.over(position), written || has(at.changes) || has(at.init_changes) ||
                                                        (increments && has(at.increment_changes)));
      if (const Position in = navigation.into(position); in.call_path.size() > position.call_path.size())
        ahead.emplace_back(in, written);
    }
  }

  frontend::VariableId variable(const std::string& name) const {
    for (std::size_t i = 0; i < shader().variables.size(); ++i)
      if (shader().variables[i].name == name) return static_cast<frontend::VariableId>(i);
    return frontend::kNone;
  }

 private:
  frontend::Analysis analysis_;
};

using Lines = std::set<int>;

TEST(Written, NotBeforeTheFirstAssignment) {
  Walker walker("void main() {\n float a;\n float b = 2.0;\n a = b;\n g = a;\n o = vec4(a + g);\n}");
  EXPECT_EQ(walker.unwritten("o"), (Lines{2, 3, 4, 5, 6}));
  EXPECT_EQ(walker.unwritten("a"), (Lines{3, 4}));
  EXPECT_EQ(walker.unwritten("g"), (Lines{2, 3, 4, 5}));
  EXPECT_EQ(walker.unwritten("b"), Lines{});
  EXPECT_EQ(walker.unwritten("h"), Lines{}) << "declared with a value";
  EXPECT_EQ(walker.unwritten("u"), Lines{});
  EXPECT_EQ(walker.unwritten("g + h"), (Lines{2, 3, 4, 5})) << "an expression that reads it";
  EXPECT_EQ(walker.unwritten("gl_FragCoord"), Lines{});
}

TEST(Written, OneBranchDoesNotRunBeforeTheOther) {
  Walker walker(
      "void main() {\n if (u > 0) {\n  o = vec4(1);\n  g = 1.0;\n } else {\n  g = 2.0;\n  h = g;\n }\n h = "
      "g;\n}");
  EXPECT_EQ(walker.unwritten("o"), (Lines{2, 3, 6, 7}));
  EXPECT_EQ(walker.unwritten("g"), (Lines{2, 3, 4, 6}));
}

TEST(Written, ALoopsBodyRunsBeforeItsNextIteration) {
  Walker walker(
      "void main() {\n for (int i = 0; i < u; ++i) {\n  h = 1.0;\n  g += 1.0;\n }\n o = vec4(g);\n}");
  bool first = false, second = false;
  walker.forAllPlaces([&](const Position& position, bool) {
    const int line = walker.shader().statements[static_cast<std::size_t>(position.statement)].place.line - 5;
    if (line != 3) return;
    const bool written = mayBeWritten(walker.shader(), position, walker.variable("g"));
    (position.iterations.back() == 0 ? first : second) = true;
    EXPECT_EQ(written, position.iterations.back() > 0);
  });
  EXPECT_TRUE(first && second);
}

TEST(Written, AnAssignmentFollowsTheCallInIt) {
  Walker walker(
      "float f(float x) {\n float y = x;\n return y;\n}\nvoid set(out float x) {\n h = 1.0;\n x = 2.0;\n h = "
      "x;\n}\n"
      "void main() {\n g = f(1.0);\n o = vec4(f(g = 3.0));\n set(h);\n}");
  EXPECT_EQ(walker.unwritten("g"), (Lines{2, 3, 11})) << "at the first visit of f";
  EXPECT_EQ(walker.unwritten("x"), (Lines{6, 7})) << "of set; that of f is given";
  EXPECT_EQ(walker.unwritten("o"), (Lines{2, 3, 11, 12}));
}

// What is called unwritten is written on no way there.
TEST(Written, HoldsOnAllWays) {
  const char* const bodies[] = {
      "void main() {\n for (int i = 0; i < u; ++i) {\n  if (i == 1) g = 1.0;\n  else continue;\n  h = g;\n "
      "}\n h = 2.0;\n}",
      "void main() {\n do {\n  if (u > 2) break;\n  h = 3.0;\n  g = 1.0;\n } while (h < 2.0);\n h = 2.0;\n}",
      "void main() {\n switch (u) {\n case 1:\n  g = 1.0;\n case 2:\n  h = 1.0;\n  break;\n default:\n  h = "
      "2.0;\n }\n h = 3.0;\n}",
      "void p(float x) {\n h = x;\n if (x > 1.0) g = x;\n h = 2.0;\n}\nvoid main() {\n p(0.0);\n for (int i "
      "= 0; i < 2; ++i) p(float(i));\n h = 1.0;\n}",
      "bool t() {\n h = 1.0;\n g = 1.0;\n return h > 0.0;\n}\nvoid main() {\n h = 3.0;\n while (t()) {\n  h "
      "= 2.0;\n }\n if (t() && h > 1.0)\n  h = 4.0;\n}",
  };
  int unwritten = 0, written = 0;
  for (const char* const body : bodies) {
    Walker walker(body);
    const frontend::VariableId g = walker.variable("g");
    walker.forAllPlaces(
        [&](const Position& position, bool on_this_way) {
          const bool may = mayBeWritten(walker.shader(), position, g);
          (may ? written : unwritten) += 1;
          EXPECT_TRUE(may || !on_this_way)
              << body << "\nat line "
              << walker.shader().statements[static_cast<std::size_t>(position.statement)].place.line - 5;
        },
        g);
  }
  EXPECT_GT(unwritten, 10);
  EXPECT_GT(written, 10);
}

}  // namespace
}  // namespace shadestep::session
