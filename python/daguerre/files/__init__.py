"""Texts and files of any kind: values that know their place, files written whole or not at all."""
