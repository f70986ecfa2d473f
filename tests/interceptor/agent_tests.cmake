# The agent's tests: a session of the tests' own against small scenes under the preload library.
find_package(PkgConfig REQUIRED)
pkg_check_modules(OSMESA REQUIRED IMPORTED_TARGET osmesa)
pkg_check_modules(GL REQUIRED IMPORTED_TARGET gl egl)

add_executable(agent-scene-osmesa agent_scene_osmesa.cpp)
target_link_libraries(agent-scene-osmesa PRIVATE PkgConfig::OSMESA)
add_executable(agent-scene-egl agent_scene_egl.cpp)
target_link_libraries(agent-scene-egl PRIVATE PkgConfig::GL)

add_executable(agent-situation agent_situation.cpp agent_situation_queries.cpp)
target_link_libraries(agent-situation PRIVATE PkgConfig::OSMESA)

add_executable(agent-target agent_target.cpp)
target_link_libraries(agent-target PRIVATE PkgConfig::OSMESA)
add_executable(agent-memory agent_memory.cpp)
target_link_libraries(agent-memory PRIVATE PkgConfig::OSMESA)

foreach(test agent_test agent_situation_test agent_target_test agent_memory_test agent_fuzz_test)
  shadestep_test(${test} SOURCES ${test}.cpp LINKS shadestep-wire LABELS interceptor)
  target_compile_definitions(${test} PRIVATE
    PRELOAD_LIBRARY="$<TARGET_FILE:shadestep-gl>"
    SCENE_OSMESA="$<TARGET_FILE:agent-scene-osmesa>"
    SCENE_EGL="$<TARGET_FILE:agent-scene-egl>"
    SITUATION="$<TARGET_FILE:agent-situation>"
    TARGET="$<TARGET_FILE:agent-target>"
    MEMORY="$<TARGET_FILE:agent-memory>")
  add_dependencies(${test} shadestep-gl agent-scene-osmesa agent-scene-egl agent-situation agent-target agent-memory)
endforeach()
