// Nothing: the target that other targets take their precompiled header from needs a source.
