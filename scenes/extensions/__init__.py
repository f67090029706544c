"""Six small scenes that together use every glTF extension that Daguerre reads."""
