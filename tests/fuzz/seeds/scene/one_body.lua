body{ circle{1} }
