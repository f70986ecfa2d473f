#include "debugger-gui/views/glsl_lexer.h"

#include "debugger-gui/style/theme.h"

namespace shadestep::gui {
namespace {

constexpr const char* kKeywords =
    "if else for while do switch case default break continue return discard struct const in out inout "
    "uniform "
    "buffer shared attribute varying layout centroid flat smooth noperspective patch sample invariant "
    "precise "
    "precision highp mediump lowp subroutine coherent volatile restrict readonly writeonly true false";

constexpr const char* kTypes =
    "void bool int uint float double vec2 vec3 vec4 dvec2 dvec3 dvec4 bvec2 bvec3 bvec4 ivec2 ivec3 ivec4 "
    "uvec2 "
    "uvec3 uvec4 mat2 mat3 mat4 mat2x2 mat2x3 mat2x4 mat3x2 mat3x3 mat3x4 mat4x2 mat4x3 mat4x4 dmat2 dmat3 "
    "dmat4 "
    "sampler1D sampler2D sampler3D samplerCube sampler2DRect samplerBuffer sampler1DArray sampler2DArray "
    "samplerCubeArray sampler2DMS sampler1DShadow sampler2DShadow samplerCubeShadow sampler2DArrayShadow "
    "isampler1D isampler2D isampler3D isamplerCube isampler2DArray isamplerBuffer usampler1D usampler2D "
    "usampler3D "
    "usamplerCube usampler2DArray usamplerBuffer image1D image2D image3D iimage2D uimage2D atomic_uint";

constexpr const char* kFunctions =
    "radians degrees sin cos tan asin acos atan sinh cosh tanh pow exp log exp2 log2 sqrt inversesqrt abs "
    "sign floor "
    "trunc round roundEven ceil fract mod modf min max clamp mix step smoothstep isnan isinf floatBitsToInt "
    "floatBitsToUint intBitsToFloat uintBitsToFloat fma frexp ldexp length distance dot cross normalize "
    "faceforward "
    "reflect refract matrixCompMult outerProduct transpose determinant inverse lessThan lessThanEqual "
    "greaterThan "
    "greaterThanEqual equal notEqual any all not texture textureLod textureProj textureOffset texelFetch "
    "textureSize "
    "textureGrad textureGather texture1D texture2D texture3D textureCube dFdx dFdy fwidth imageLoad "
    "imageStore "
    "gl_FragCoord gl_FragColor gl_FragData gl_FragDepth gl_FrontFacing gl_Position gl_VertexID gl_InstanceID";

}  // namespace

GlslLexer::GlslLexer(QObject* parent) : QsciLexerCPP(parent) {
  setFoldCompact(false);
  applyTheme();
}

const char* GlslLexer::keywords(int set) const {
  return set == 1 ? kKeywords : set == 2 ? kTypes : set == 4 ? kFunctions : nullptr;
}

void GlslLexer::applyTheme() {
  const Theme& colors = theme();
  setDefaultFont(monospaced());
  setFont(monospaced());
  setDefaultPaper(colors.panel);
  setPaper(colors.panel);
  setDefaultColor(colors.text);
  setColor(colors.text);
  for (const int style : {Comment, CommentLine, CommentDoc, CommentLineDoc}) setColor(colors.comment, style);
  setColor(colors.keyword, Keyword);
  setColor(colors.type, KeywordSet2);
  setColor(colors.type, GlobalClass);
  setColor(colors.number, Number);
  setColor(colors.preprocessor, PreProcessor);
  setColor(colors.string, DoubleQuotedString);
  QFont bold = monospaced();
  bold.setBold(true);
  setFont(bold, Keyword);
}

}  // namespace shadestep::gui
