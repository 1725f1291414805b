# cmake -D OUTPUT=parts.cpp -D HEADER=folder/parts.h -D NAMESPACE=a::b -D PARTS=kName:file,file;... -P EmbedFiles.cmake
# Writes a source that defines each `const std::string_view kName` as the content of its files, one after the other.
# A part without files is empty.
set(definitions "")
set(number 0)
foreach(part IN LISTS PARTS)
    string(REGEX MATCH "^[^:]+" name "${part}")
    string(REGEX REPLACE "^[^:]+:" "" files "${part}")
    string(REPLACE "," ";" files "${files}")
    set(bytes "")
    foreach(file IN LISTS files)
        file(READ "${file}" hex HEX)
        string(APPEND bytes "${hex}")
    endforeach()
    string(LENGTH "${bytes}" digits)
    math(EXPR length "${digits} / 2")
    # Character literals: bytes above 127 do not fit a signed char as numbers, and long strings are not standard.
    string(REGEX REPLACE "(................................................)" "\\1\n" bytes "${bytes}")
    string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${bytes}")
    string(APPEND definitions "const char kBytes${number}[] = {\n${bytes}'\\0'};\n"
                              "const std::string_view ${name}(kBytes${number}, ${length});\n")
    math(EXPR number "${number} + 1")
endforeach()
file(WRITE "${OUTPUT}" "#include \"${HEADER}\"\n\nnamespace ${NAMESPACE} {\n${definitions}}\n")
