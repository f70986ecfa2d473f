// The window's state: which program, which draw, where in the shader, which pixel, which values. The panels
// read it, ask it for things, and hear when something has changed. Lives on the main thread and never waits.
#pragma once

#include <QMap>
#include <QObject>
#include <QSocketNotifier>
#include <QStringList>
#include <optional>

#include "debugger-gui/backend/backend.h"

namespace shadestep::gui {

// What is started, as the start dialog and the session file have it.
struct ProgramSpec {
  QStringList command;
  QStringList environment;  // NAME=value, laid over the window's own
  QString directory;
  std::uint64_t frame = 0, draw = 0;  // the draw to stop at first
};

struct Breakpoint {
  bool enabled = true;
  QString condition;  // a bool expression of the picked thread's values; empty = always
  int ignore = 0;     // of the times that the condition holds, so many are passed by first
};

// Which picture the picture view shows.
struct PictureSource {
  enum class Kind { target, value, outcome, iterations, cost, difference, texture } kind = Kind::target;
  QString name;   // value: the expression; texture: the sampler
  int index = 0;  // target: the output; iterations: the loop
  bool operator==(const PictureSource&) const = default;
};

// A place in a shader as the session file has it.
struct SavedPlace {
  session::Stage stage = session::Stage::fragment;
  QByteArray source;  // tells another text of the shader, in which the numbers of the position mean nothing
  session::Position position;
};

struct KnownConditions;

class Debugger : public QObject {
  Q_OBJECT
 public:
  enum class Program {
    none,
    running,  // towards a draw, or its own end
    stopped,  // at a draw
    waiting,  // at a call that is no draw, or behind the last draw of a frame
    ended,
  };

  explicit Debugger(QObject* parent = nullptr);
  ~Debugger() override;

  // ---- what there is
  Program program() const { return program_; }
  const ProgramSpec& spec() const { return spec_; }
  const std::optional<Stop>& stop() const { return stop_; }
  const QList<DrawEntry>& draws() const { return draws_; }
  // By frame: how often what was called from the first draw listed on.
  const QMap<std::uint64_t, FrameList>& listed() const { return listed_; }
  const std::optional<Place>& place() const { return place_; }
  const std::optional<session::CallStop>& call() const { return call_; }    // at which the program waits
  const std::vector<session::LoggedCall>& calls() const { return calls_; }  // made on the way here, if logged
  const LookPtr& values() const { return values_; }
  const LookPtr& previousValues() const { return previous_values_; }  // at the place before
  session::Stage stage() const { return picked_.stage; }              // that is looked at
  const Picked& picked() const { return picked_; }
  std::optional<std::size_t> pickedIndex() const;  // among values(); nothing if it is not there
  QString pickedName() const;                      // "140, 120", "vertex 7, instance 0"; "" if none is
  // Of the fragment stage, whichever stage is looked at.
  const std::optional<Pixel>& pixel() const;
  const OriginPtr& origin() const { return origin_; }  // the threads that the pixel's fragment comes from
  const EmitsPtr& emits() const { return emits_; }
  const RunPtr& run() const { return run_; }
  const QString& runReason() const { return run_reason_; }  // why there is no run
  // At the place, by the picked thread, or by any: what the driver holds there is no value.
  bool unwritten(const QString& expression) const;
  int runStep() const;  // the place's step in the run; -1: not on it
  const TargetPtr& target() const { return target_; }
  const LoopsPtr& loops() const { return loops_; }
  const ProfilePtr& profile() const { return profile_; }  // of this draw or an earlier one
  bool profileIsOfThisDraw() const;
  const GlState& glState() const { return gl_state_; }
  const TextureListPtr& textures() const { return textures_; }  // null: not asked for yet
  const TexturePtr& texture() const { return texture_; }
  const BufferListPtr& buffers() const { return buffers_; }  // null: not asked for yet
  const BufferPtr& buffer() const { return buffer_; }        // whose contents were asked for last
  const session::FragmentChoice& fragments() const { return fragments_; }
  QMap<int, Breakpoint> breakpoints() const { return breakpoints_.value(stage()); }  // by line
  const QStringList& watches() const { return watches_; }
  const PictureSource& picture() const { return picture_; }
  std::optional<session::Check> check() const;  // of the values shown
  bool idle() const { return backend_.idle(); }
  Backend& backend() { return backend_; }
  bool canStep() const;
  bool canGoBack() const;
  const StageSource* source() const { return source(stage()); }
  const StageSource* source(session::Stage) const;  // null where the draw has no such stage

  // ---- the program
  void start(const ProgramSpec&);
  void goTo(std::uint64_t frame, std::uint64_t draw);
  void nextDraw();
  void runUntil(const QString& what, const session::StopCondition&);
  void pause();  // stops a running program at its next call
  void setArgument(const QString& name, const QString& value);
  void skipCall();
  void logCalls(bool on);
  bool canRun() const { return program_ == Program::stopped || program_ == Program::waiting; }
  void nextFrame();
  // From the draw at which the program stands, or where the last list of its frame ended.
  void listFrame(Listing = Listing::draws);
  void list(std::uint64_t frame, std::uint64_t first, Listing);  // some draws from this one on
  void runToEnd();
  void endProgram();
  // Stops what takes long, with what there is until then. A running program waits at its next call; asked
  // for a second time, it is ended.
  void cancel();

  // ---- in the shader
  void move(Move);
  void toLine(int line);
  void choose(const QString& side);
  void restartShader();
  void setIteration(std::size_t loop, int iteration);  // loop: index into Place::loops
  void moveToStep(int step);                           // of the picked thread's run
  void resume(bool backwards);                         // to the next breakpoint on the picked thread's way
  void back();  // to where the last step came from; along the run if there is one
  void backInto();
  void backOut();

  void selectStage(session::Stage);  // starts at its main
  // In another stage than the fragment stage: the threads that its fragment comes from.
  void pick(std::optional<Pixel>);
  void pick(const session::ThreadName&);  // of the stage that is looked at
  // The threads of that stage which the picked pixel's fragment comes from; goes to the first of them.
  void askOrigin(session::Stage);
  void setBreakpoint(int line, std::optional<Breakpoint>);
  void toggleBreakpoint(int line);
  void addWatch(const QString& expression);
  void removeWatch(const QString& expression);
  void show(const PictureSource&);

  // ---- all of the draw
  void askEmits();
  void askLoops();
  void askProfile(const CostRequest&);
  void askGlState();
  void askTextures();
  void askTexture(const QString& sampler, int level, int slice);  // and shows it
  void askBuffers();
  void askBuffer(const session::BoundBuffer&);
  void setFragments(const session::FragmentChoice&);

  // ---- the session file: program, draw, pixel, place in the shader, picture, breakpoints, watches
  QByteArray saved() const;
  void restore(const QByteArray&);  // starts the program; throws session::Error{usage} for another file

 Q_SIGNALS:
  void programChanged();
  void drawsChanged();
  void stopChanged();
  void callChanged();
  void placeChanged();
  void valuesChanged();
  void stageChanged();
  void pickedChanged();
  void originChanged();
  void emitsChanged();
  void runChanged();
  void targetChanged();
  void loopsChanged();
  void profileChanged();
  void glStateChanged();
  void texturesChanged();
  void buffersChanged();
  void bufferChanged();
  void breakpointsChanged();
  void watchesChanged();
  void pictureChanged();
  void message(const QString& sentence, bool is_error);

 private:
  void leaveStop();
  void setProgram(Program);
  void arrived(Stop);
  void halted(Halt);
  void askCall();
  void placed(Place);
  void lookAgain();
  void lookAhead();
  void followRun();
  void setPicked(const Picked&);
  void changeStage(session::Stage);
  void failed(const QString& what, const QString& sentence, session::Outcome);
  void watchProcess();
  void forgetProcess();
  void askTarget();
  void askPlace(const QString& what, std::function<Place(Debuggee&)> work);
  void goBackTo(int deepest, bool inside_statements);
  void backAlongWay();
  QStringList expressions() const;
  void addDraw(const DrawEntry&);
  void addList(const FrameList&);
  QByteArray sourceMark() const;
  void resumePlace();

  Backend backend_;
  Program program_ = Program::none;
  bool cancelling_ = false;  // of a running program
  ProgramSpec spec_;
  std::optional<Stop> stop_;
  QList<DrawEntry> draws_;
  QMap<std::uint64_t, FrameList> listed_;  // their draws stand in draws_
  int listing_ = 0;                        // which list is under way; none of before the program's start
  std::optional<Place> place_;
  std::optional<session::CallStop> call_;
  std::vector<session::LoggedCall> calls_;
  std::vector<session::Position> way_;  // positions before the present one
  LookPtr values_, previous_values_;
  Picked picked_;
  QMap<session::Stage, Picked> picks_;  // of the other stages
  OriginPtr origin_;
  EmitsPtr emits_;
  RunPtr run_;
  QString run_reason_;
  std::shared_ptr<KnownConditions> conditions_;  // of breakpoints, on that run; the worker's
  TargetPtr target_;
  LoopsPtr loops_;
  ProfilePtr profile_;
  std::pair<std::uint64_t, std::uint64_t> profiled_;  // frame and draw
  GlState gl_state_;
  TextureListPtr textures_;
  TexturePtr texture_;
  BufferListPtr buffers_;
  BufferPtr buffer_;
  session::FragmentChoice fragments_;
  QMap<session::Stage, QMap<int, Breakpoint>> breakpoints_;
  QStringList watches_;
  PictureSource picture_;
  std::optional<SavedPlace> resume_at_;  // of a session file, once the program is at its draw
  std::unique_ptr<QSocketNotifier> process_end_;
};

}  // namespace shadestep::gui
