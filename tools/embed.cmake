# Writes a file's bytes as the C array NAME, with NAME_size: cmake -DINPUT=... -DOUTPUT=... -DNAME=... -P embed.cmake
#
# SPDX-License-Identifier: MIT
file(READ ${INPUT} bytes HEX)
string(LENGTH "${bytes}" length)
math(EXPR size "${length}/2")
string(REGEX REPLACE "(................................)" "\\1\n" bytes "${bytes}")
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
file(WRITE ${OUTPUT} "#include \"cli/watch_page.h\"\n\nconst unsigned char ${NAME}[] = {\n${bytes}};\n"
    "const size_t ${NAME}_size = ${size};\n")
