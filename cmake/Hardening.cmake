# Hardening of optimised builds (docs/reliability.md): the program reads what strangers send. The options are
# those of this project's folders; a project that builds these libraries as part of its own keeps its own.
include(CheckCXXCompilerFlag)

set(STIPPLE_HARDENED "$<CONFIG:Release,RelWithDebInfo,MinSizeRel>")
# Some distributions define _FORTIFY_SOURCE already, as another level.
set(options -fstack-protector-strong -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=3)
check_cxx_compiler_flag(-ftrivial-auto-var-init=zero STIPPLE_HAS_AUTO_VAR_INIT)  # clang 14 has not
if(STIPPLE_HAS_AUTO_VAR_INIT)
    list(APPEND options -ftrivial-auto-var-init=zero)
endif()
add_compile_options("$<${STIPPLE_HARDENED}:${options}>")
add_link_options("$<${STIPPLE_HARDENED}:LINKER:-z,relro,-z,now>")
